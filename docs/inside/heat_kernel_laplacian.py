"""The mesh Laplacian of Belkin, Sun and Wang (2008), given as two matrices, on the unit sphere.

Its Gaussian of width t has the eigenvalues 2 and 6 - 12 t there, up to exp(-1 / t): what differs from them is the mesh's.
"""

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.spatial import cKDTree

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.operators.matrix_operator import matrix_operator
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.surface_spectrum import surface_spectrum


def heat_kernel_laplacian(mesh: TriangleMesh, t: float) -> SurfaceOperator:
    """Return the operator f(x) -> int exp(-|x - y|^2 / 4 t) (f(x) - f(y)) dy / (4 pi t^2), by one point a vertex."""
    areas = fem(mesh).mass
    far = np.sqrt(4.0 * t * np.log(1e14))
    near = cKDTree(mesh.vertices).sparse_distance_matrix(cKDTree(mesh.vertices), far, output_type="coo_matrix")
    weights = np.exp(-(near.data**2) / (4.0 * t)) / (4.0 * np.pi * t**2) * areas[near.row] * areas[near.col]
    kernel = csr_array((weights, (near.row, near.col)), shape=near.shape)
    stiffness = diags_array(kernel.sum(axis=1)) - kernel
    return matrix_operator(mesh, csr_array(stiffness), csr_array(diags_array(areas)), "heat kernel")


if __name__ == "__main__":
    for levels, t in ((2, 0.1), (3, 0.05), (3, 0.025)):
        sphere = icosphere(levels)
        values = surface_spectrum(sphere, heat_kernel_laplacian(sphere.mesh, t), 9, method="dense").values
        print(f"{len(sphere.mesh.vertices)} vertices, t = {t:g}: {values[1:4].mean():.4f} for 2, ", end="")
        print(f"{values[4:].mean():.4f} for {6 - 12 * t:.4f}")
