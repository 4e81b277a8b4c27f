"""A Laplacian that is given as two matrices, by whatever method they were made."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.extras import require_installed
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import check_mesh
from surfexp.operators.surface_operator import SurfaceOperator

ROUNDING = 1e-9


def matrix_operator(mesh: TriangleMesh, stiffness: csr_array, mass: csr_array, name: str) -> SurfaceOperator:
    """Return the operator M^-1 L on the vertices of a mesh, without gradients.

    Parameters
    ----------
    mesh : TriangleMesh
        Its triangles give areas and neighbours, nothing else.
    stiffness : (n, n) csr_array
        L, symmetric with constants in its kernel, positive semidefinite (which is not checked): minus the weak Laplacian.
    mass : (n, n) csr_array
        M, symmetric with positive row sums; often diagonal.
    name : str

    Raises
    ------
    ValueError
        If a matrix does not have these properties up to rounding, or the mesh a degenerate face.
    """
    check_mesh(mesh, flat_faces=True)
    count = len(mesh.vertices)
    matrices = csr_array(stiffness, dtype=np.float64, copy=True), csr_array(mass, dtype=np.float64, copy=True)
    for what, matrix in zip(("stiffness", "mass"), matrices, strict=True):
        if matrix.shape != (count, count):
            raise ValueError(f"{what} of operator {name!r} has shape {matrix.shape}, the mesh has {count} vertices")
        if not np.isfinite(matrix.data).all():
            raise ValueError(f"{what} of operator {name!r} has entries that are not finite")
        skew = float(abs(matrix - matrix.T).max()) if matrix.nnz else 0.0
        if skew > ROUNDING * float(abs(matrix).max()):
            raise ValueError(f"{what} of operator {name!r} differs from its transpose by {skew:.2g}, must be symmetric")
        matrix.sort_indices()
    diagonal = matrices[0].diagonal()
    constants = np.abs(matrices[0].sum(axis=1)).max()
    if constants > ROUNDING * np.abs(diagonal).max():
        raise ValueError(f"stiffness of operator {name!r} takes constants to {constants:.2g}, its rows must sum to 0")
    if diagonal.min() < 0:
        raise ValueError(f"stiffness of operator {name!r} has {diagonal.min():.2g} on its diagonal: change its sign")
    lowest = float(matrices[1].sum(axis=1).min())
    if lowest <= 0:
        raise ValueError(f"a row of the mass of operator {name!r} sums to {lowest:.2g}, must be positive")
    return SurfaceOperator(mesh.faces, None, mesh.areas, count, name=name, matrices=matrices)


def robust_laplacian(mesh: TriangleMesh, mollify: float = 1e-5) -> SurfaceOperator:
    """Return the tufted Laplacian: intrinsic Delaunay edges on a double cover, so that no triangle is too bad.

    On a closed manifold whose triangulation is Delaunay it is the cotangent matrix.

    Parameters
    ----------
    mesh : TriangleMesh
    mollify : float
        Share of the mean edge length by which triangles are kept from degenerating.

    Raises
    ------
    ImportError
        If the package robust_laplacian is missing.
    ValueError
        As `matrix_operator`.

    References
    ----------
    Sharp, Crane: A Laplacian for nonmanifold triangle meshes (2020).
    """
    require_installed("operator robust_laplacian", "robust_laplacian")
    import robust_laplacian as package

    stiffness, mass = package.mesh_laplacian(np.array(mesh.vertices), np.array(mesh.faces), mollify_factor=mollify)
    symmetric = csr_array(0.5 * (stiffness + stiffness.T))
    return matrix_operator(mesh, symmetric, csr_array(mass), "robust_laplacian")
