"""Linear elements on tetrahedra: stiffness and mass of the Laplace operator of a solid."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.tetrahedra import signed_volumes


def solid_stiffness(vertices: Floats, tetrahedra: Integers) -> csr_array:
    """Return the integrals of grad phi_i . grad phi_j.

    Parameters
    ----------
    vertices : (n, 3) float64
    tetrahedra : (m, 4) int64
        Of positive volume.

    Returns
    -------
    (n, n) csr_array
    """
    edges = vertices[tetrahedra[:, 1:]] - vertices[tetrahedra[:, :1]]
    # the columns of the inverse are the gradients of the functions of the corners 1, 2, 3
    slopes = np.linalg.inv(edges).transpose(0, 2, 1)
    gradients = np.concatenate([-slopes.sum(axis=1, keepdims=True), slopes], axis=1)
    energies = np.einsum("mik,mjk->mij", gradients, gradients) * signed_volumes(vertices, tetrahedra)[:, None, None]
    return _assembled(energies, tetrahedra, len(vertices))


def solid_mass(vertices: Floats, tetrahedra: Integers) -> csr_array:
    """Return the integrals of phi_i phi_j: a tenth of the volume for i = j, a twentieth for others, in each tetrahedron.

    Parameters
    ----------
    vertices : (n, 3) float64
    tetrahedra : (m, 4) int64
        Of positive volume.

    Returns
    -------
    (n, n) csr_array
    """
    shares = (1.0 + np.eye(4)) / 20.0
    return _assembled(signed_volumes(vertices, tetrahedra)[:, None, None] * shares, tetrahedra, len(vertices))


def _assembled(local: Floats, tetrahedra: Integers, size: int) -> csr_array:
    rows, columns = np.repeat(tetrahedra, 4, axis=1).ravel(), np.tile(tetrahedra, 4).ravel()
    matrix = csr_array((local.ravel(), (rows, columns)), shape=(size, size))
    matrix.sum_duplicates()
    # sums in another order differ in the last digit
    return csr_array(0.5 * (matrix + matrix.T))
