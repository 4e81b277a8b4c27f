"""The published gradient (1.26): the area-weighted mean of the face gradients around each vertex."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array, diags_array

from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import assemble
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator


def vertex_averaged(mesh: TriangleMesh, tangent: bool = False) -> SurfaceOperator:
    """Return the operator whose solvers use W of (1.26) and the published divergence V -> W . V of (1.27).

    The pair is not adjoint: <W f, V> + <f, W . V> vanishes only on flat meshes without boundary. On tangent fields the
    defect falls with the square of the mesh size instead of the first power.

    Parameters
    ----------
    mesh : TriangleMesh
    tangent : bool
        Project gradients to the plane normal to the vertex normal, as the text assumes fields to be.

    Returns
    -------
    SurfaceOperator
        `averaged_gradient` holds W (projected when `tangent`), `consistent` is False; faces, hat gradients and areas are
        those of `fem`, with which results are audited.

    Raises
    ------
    ValueError
        As `fem`.
    """
    operator = fem(mesh)
    assert operator.frames is not None  # noqa: S101, narrows a type
    in_space = np.einsum("fka,fax->fkx", operator.hat_gradients, operator.frames)
    inverse_ring = diags_array(1.0 / (3.0 * operator.mass))
    weighted = operator.areas[:, None, None] * in_space
    rows = [
        inverse_ring @ assemble(mesh.faces, weighted[:, None, :, x].repeat(3, 1), len(mesh.vertices)) for x in range(3)
    ]
    if tangent:
        normals = mesh.vertex_normals
        along = sum((diags_array(normals[:, x]) @ rows[x] for x in range(3)), start=csr_array(rows[0].shape))
        rows = [rows[x] - diags_array(normals[:, x]) @ along for x in range(3)]
    x, y, z = (csr_array(row) for row in rows)
    name = "vertex_averaged_tangent" if tangent else "vertex_averaged"
    notes = ("The published divergence is not the adjoint of the published gradient: no energy gap of its own exists.",)
    return replace(operator, averaged_gradient=(x, y, z), name=name, consistent=False, notes=notes)
