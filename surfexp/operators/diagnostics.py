"""How far an operator is from a gradient and its negative adjoint: defect and null modes."""

from __future__ import annotations

import numpy as np
from scipy.sparse import diags_array

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import divergence, gradient_matrix
from surfexp.operators.surface_operator import SurfaceOperator

FIELDS = 16


def adjointness_defect(operator: SurfaceOperator, normals: Floats | None = None) -> float:
    """Return |G^T A + M D| / |G^T A| in the Frobenius norm, D the divergence that solvers use; 0 for an adjoint pair.

    For face fields it is taken over random fields, D applied as solvers do. For the published pair this is
    |C + C^T| / |C|, C_ij = int e_i grad e_j: zero on flat meshes without boundary only.

    Parameters
    ----------
    operator : SurfaceOperator
    normals : (n, 3) float64, optional
        Counts only fields at the vertices that are perpendicular to these; for vertex-averaged operators.
    """
    rows = operator.averaged_gradient
    if rows is None:
        fields = np.random.default_rng(0).normal(size=(len(operator.faces), FIELDS, 2))
        weighted = (operator.areas[:, None, None] * fields).transpose(0, 2, 1).reshape(-1, FIELDS)
        load = gradient_matrix(operator).T @ weighted
        defect = load + operator.mass[:, None] * divergence(operator, fields)
        return float(np.linalg.norm(defect) / np.linalg.norm(load))
    weighted_rows = [diags_array(operator.mass) @ row for row in rows]
    size = sum(float(np.linalg.norm(row.data)) ** 2 for row in weighted_rows)
    defects = [row + row.T for row in weighted_rows]
    if normals is not None:
        along = sum(diags_array(normals[:, x]) @ defects[x] for x in range(3))
        defects = [defects[x] - diags_array(normals[:, x]) @ along for x in range(3)]
    return float(np.sqrt(sum(float(np.linalg.norm(defect.data)) ** 2 for defect in defects) / size))


def null_modes(operator: SurfaceOperator, tolerance: float = 1e-9) -> int:
    """Return the dimension of the kernel of the gradient that solvers use, by a dense decomposition.

    One for each connected component is right.

    Raises
    ------
    ValueError
        If the operator has more than 3000 vertices.
    """
    if operator.vertex_count > 3000:
        raise ValueError(f"null modes take a dense decomposition, {operator.vertex_count} vertices are more than 3000")
    rows = operator.averaged_gradient
    gram: Floats
    if rows is None:
        weighted = diags_array(np.repeat(operator.areas, 2)) @ gradient_matrix(operator)
        gram = (gradient_matrix(operator).T @ weighted).toarray()
    else:
        gram = np.sum([(row.T @ diags_array(operator.mass) @ row).toarray() for row in rows], axis=0)
    eigenvalues = np.linalg.eigvalsh(gram)
    return int((eigenvalues <= tolerance * eigenvalues[-1]).sum())
