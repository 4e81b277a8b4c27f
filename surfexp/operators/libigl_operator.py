"""The same finite elements taken from libigl, an independent implementation."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import check_mesh, fem
from surfexp.operators.surface_operator import SurfaceOperator


def libigl_operator(mesh: TriangleMesh) -> SurfaceOperator:
    """Return the linear finite element operator whose gradient and areas come from libigl.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    SurfaceOperator
        Agrees with `fem` to rounding; its frames are those of `fem`, for libigl gives gradients in space.

    Raises
    ------
    ValueError
        As `fem`.
    """
    import igl

    check_mesh(mesh)
    faces, count = mesh.faces, len(mesh.faces)
    gradient = csr_array(igl.grad(mesh.vertices.copy(), faces.copy()))
    areas = 0.5 * np.asarray(igl.doublearea(mesh.vertices.copy(), faces.copy()), dtype=np.float64)
    rows = np.arange(count)[:, None] + count * np.arange(3)
    hats_in_space = np.stack([gradient[rows, faces[:, [k, k, k]]].toarray() for k in range(3)], axis=1)
    frames = fem(mesh).frames
    assert frames is not None  # noqa: S101, narrows a type
    hat_gradients = np.einsum("fkx,fax->fka", hats_in_space, frames)
    return SurfaceOperator(faces, hat_gradients, areas, len(mesh.vertices), frames, name="libigl")
