"""Corners at one position become one vertex."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers


def weld(corners: Floats) -> tuple[Floats, Integers]:
    """Vertices and faces of (m, 3, 3) corner positions, numbered as they first appear."""
    _, first, number = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return corners.reshape(-1, 3)[first[order]], rank[number.ravel()].reshape(-1, 3)
