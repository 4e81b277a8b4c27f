"""Corners at one position become one vertex."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.equal_rows import first_equal_row


def weld(corners: Floats) -> tuple[Floats, Integers]:
    """Vertices and faces of (m, 3, 3) corner positions, numbered as they first appear."""
    points = corners.reshape(-1, 3)
    first = first_equal_row(points)
    kept = first == np.arange(len(points))
    return points[kept], (np.cumsum(kept) - 1)[first].reshape(-1, 3)
