"""How much of a map the first k functions of a basis explain, for all k at once."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats

# beyond this condition of the normed Gram matrix the second pass of Cholesky QR cannot mend the first one
LARGEST_CONDITION = 1e12
CONSTANT_SHARE = 1e-6


def orthonormal_in(basis: Floats, mass: csr_array) -> Floats:
    """Return a basis made orthonormal in the order of its columns, so that the first k keep their span for every k.

    Cholesky QR in the inner product of the mass, done twice so that it is orthonormal to rounding.

    Parameters
    ----------
    basis : (n, k) float64
        Independent columns, such as eigenfunctions of another surface with the same vertices.
    mass : (n, n) csr_array
        Symmetric, positive definite.

    Returns
    -------
    (n, k) float64

    Raises
    ------
    ValueError
        If shapes do not fit, or columns are dependent up to rounding.
    """
    if basis.ndim != 2 or len(basis) != mass.shape[0] or not 1 <= basis.shape[1] <= len(basis):
        raise ValueError(f"basis has shape {basis.shape}, take 1 to {mass.shape[0]} columns of {mass.shape[0]} values")
    result = np.array(basis, dtype=np.float64)
    for _ in range(2):
        result /= np.sqrt(np.maximum((result * (mass @ result)).sum(axis=0), np.finfo(float).tiny))
        gram = result.T @ (mass @ result)
        condition = float(np.linalg.cond(gram))
        if not condition < LARGEST_CONDITION:
            raise ValueError(
                f"the Gram matrix of the basis has condition {condition:.2g}, must be below {LARGEST_CONDITION:g}: "
                "leave out functions that depend on the others"
            )
        result = solve_triangular(np.linalg.cholesky(gram), result.T, lower=True).T
    return np.ascontiguousarray(result)


def accuracy_curves(basis: Floats, mass: csr_array, maps: Floats) -> Floats:
    """Return the correlation by area of maps with what the first k functions of a basis make of them, k = 1, 2, ...

    The reconstruction is the least-squares one in the inner product of the mass. Its errors being orthogonal to it, and
    the constants in it, the correlation is the root of the share of the variance that is explained: it never decreases.

    Parameters
    ----------
    basis : (n, k) float64
        Its first function is constant.
    mass : (n, n) csr_array
        Of the surface on which the maps live, whatever surface the basis comes from.
    maps : (n, m) float64

    Returns
    -------
    (k, m) float64
        Between 0 and 1; 0 for k = 1.

    Raises
    ------
    ValueError
        If shapes do not fit, the first function is not constant, or a map is.
    """
    if maps.ndim != 2 or len(maps) != len(basis) or not np.isfinite(maps).all():
        raise ValueError(f"maps have shape {maps.shape}, take {len(basis)} rows of finite values")
    first = basis[:, 0]
    if np.ptp(first) > CONSTANT_SHARE * np.abs(first).max():
        raise ValueError(f"the first function of the basis varies by {np.ptp(first):.3g}, must be constant")
    functions = orthonormal_in(basis, mass)
    coefficients = functions.T @ (mass @ maps)
    weights = np.asarray(mass.sum(axis=1)).ravel()
    centred = maps - weights @ maps / weights.sum()
    variances = (centred * (mass @ centred)).sum(axis=0)
    constant = np.flatnonzero(variances <= CONSTANT_SHARE**2 * (maps * (mass @ maps)).sum(axis=0))
    if len(constant):
        raise ValueError(f"map {constant[0]} is constant, its correlation with anything is not defined")
    shares = np.cumsum(coefficients[1:] ** 2, axis=0) / variances
    return np.vstack([np.zeros((1, maps.shape[1])), np.sqrt(np.minimum(shares, 1.0))])


def area_over_log(curves: Floats, first: int = 10, last: int = 400) -> Floats:
    """Return the mean of curves over log k between two numbers of functions, by trapezoids: the area, over its width.

    Parameters
    ----------
    curves : (k, m) float64
        Row k - 1 belongs to k functions.
    first, last : int

    Returns
    -------
    (m,) float64

    Raises
    ------
    ValueError
        Unless 1 <= first < last <= k.
    """
    if not 1 <= first < last <= len(curves):
        raise ValueError(f"from {first} to {last} functions: take 1 <= first < last <= {len(curves)}")
    logs = np.log(np.arange(first, last + 1, dtype=np.float64))
    part = curves[first - 1 : last]
    areas = (0.5 * (part[1:] + part[:-1]) * np.diff(logs)[:, None]).sum(axis=0)
    return np.asarray(areas / (logs[-1] - logs[0]))
