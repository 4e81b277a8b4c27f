"""The Laplace-Beltrami eigenmap of a surface as a feature function (5.1)-(5.4)."""

from __future__ import annotations

import numpy as np

from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.skeleton.feature import Feature
from surfexp.spectrum.eigensolver import eigenpairs

NEARLY_DOUBLE = 0.05


def eigenmap(operator: SurfaceOperator, index: int = 1) -> Feature:
    """Eigenfunction number `index` of A_w phi = lambda B phi (5.4) with free boundary, counted from 0, which is constant.

    The weight is that of the operator; the sign is arbitrary, made positive at the entry of largest modulus.

    Returns
    -------
    Feature
        Metrics: eigenvalue, its relative distance "gap" to the next one, residual. A note says so where the gap is under 5 %:
        meshing alone opens one of up to 2 % in a double eigenvalue (a Y of equal arms, edges from an eighth to a quarter of
        their width), so that the mesh decides which function comes out.

    Raises
    ------
    ValueError
        If the index is under 1 or too large, or the surface in pieces.
    """
    if not 1 <= index <= operator.vertex_count // 4 - 2:
        raise ValueError(f"eigenmap of index {index}: take 1 to {operator.vertex_count // 4 - 2}, 0 is constant")
    system = eigenpairs(stiffness(operator), mass_matrix(operator), index + 2)
    values = system.values
    scale = float(values[index])
    if values[1] < 1e-9 * float(values[-1]):
        raise ValueError("the second eigenvalue is 0, the surface is in pieces: keep one component")
    gap = float(min(values[index + 1] - values[index], values[index] - values[index - 1])) / scale
    notes: tuple[str, ...] = ()
    if gap < NEARLY_DOUBLE:
        notes = (f"Eigenvalue {index} is nearly double (gap {gap:.1e}): the mesh may decide which function comes out.",)
    metrics = {"eigenvalue": scale, "gap": gap, "residual": float(system.residuals[index])}
    return Feature(np.ascontiguousarray(system.vectors[:, index]), f"eigenmap {index}", "", metrics, notes)
