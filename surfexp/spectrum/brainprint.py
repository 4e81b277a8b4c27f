"""BrainPrint: shape DNA as LaPy computes it, for comparison with published studies."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from surfexp.extras import require_installed
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.spectrum.signature import Signature


def brainprint(mesh: TriangleMesh, count: int = 50) -> Signature:
    """Return the first eigenvalues after 0 by LaPy, times the area and over their number (Wachinger et al. 2015).

    Parameters
    ----------
    mesh : TriangleMesh
    count : int

    Raises
    ------
    ImportError
        If LaPy is not installed.
    ValueError
        If so many values cannot be found.
    """
    if not 1 <= count < len(mesh.vertices) - 1:
        raise ValueError(
            f"count = {count} values of {len(mesh.vertices)} vertices: take at most {len(mesh.vertices) - 2}"
        )
    require_installed("brainprint", "lapy")
    lapy: Any = import_module("lapy")
    shape_dna: Any = import_module("lapy.shapedna")
    surface = lapy.TriaMesh(mesh.vertices, mesh.faces)
    # compute_shapedna starts at random each time; this is its solver, seeded
    values, _ = lapy.Solver(surface).eigs(k=count + 1, rng=0)
    scaled = shape_dna.normalize_ev(surface, values, method="geometry")[1:]
    reweighted = np.asarray(scaled, dtype=np.float64) / np.arange(1.0, count + 1.0)
    return Signature(reweighted, "brainprint", metrics={"first": float(reweighted[0]), "last": float(reweighted[-1])})
