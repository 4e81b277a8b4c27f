"""Order of convergence: the slope of the error over the mesh size."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats


def convergence_order(mesh_sizes: Floats, errors: Floats) -> float:
    """Slope of log(error) over log(h), by least squares over the finer half of the meshes, at least two.

    Raises
    ------
    ValueError
        If there are fewer than two points, or one is not positive.
    """
    h, e = np.asarray(mesh_sizes, dtype=float), np.asarray(errors, dtype=float)
    if h.shape != e.shape or len(h) < 2 or not (h > 0.0).all() or not (e > 0.0).all():
        raise ValueError(f"order of {e.tolist()} at h = {h.tolist()}: two or more pairs of positive numbers are needed")
    fine = np.argsort(h)[: max(2, (len(h) + 1) // 2)]
    return float(np.polyfit(np.log(h[fine]), np.log(e[fine]), 1)[0])
