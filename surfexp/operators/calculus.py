"""Gradient, divergence and total variation of piecewise linear functions."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.surface_operator import SurfaceOperator


def gradient(operator: SurfaceOperator, values: Floats) -> Floats:
    """Return the gradient of a function in the frame of each face.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) or (n, c) float64

    Returns
    -------
    (m, 2) or (m, c, 2) float64
    """
    channels = check_length(operator.vertex_count, "vertices", values).reshape(operator.vertex_count, -1)
    result = np.empty((len(operator.faces), channels.shape[1], 2))
    _gradient(operator.faces, operator.hat_gradients, channels, result)
    return result.reshape(len(operator.faces), *np.shape(values)[1:], 2)


def adjoint_gradient(operator: SurfaceOperator, field: Floats) -> Floats:
    """Return G^T A p, the load vector of a field: its inner product with f is <grad f, p>.

    Parameters
    ----------
    operator : SurfaceOperator
    field : (m, 2) or (m, c, 2) float64

    Returns
    -------
    (n,) or (n, c) float64
    """
    count = len(operator.faces)
    channels = check_length(count, "faces", field).reshape(count, -1, 2)
    result = np.zeros((operator.vertex_count, channels.shape[1]))
    _adjoint(operator.faces, operator.hat_gradients, operator.areas, channels, result)
    return result.reshape(operator.vertex_count, *np.shape(field)[1:-1])


def divergence(operator: SurfaceOperator, field: Floats) -> Floats:
    """Return div p = -M^-1 G^T A p, the negative adjoint of `gradient` in the lumped mass.

    Parameters
    ----------
    operator : SurfaceOperator
    field : (m, 2) or (m, c, 2) float64

    Returns
    -------
    (n,) or (n, c) float64
    """
    load = adjoint_gradient(operator, field)
    return -load / operator.mass.reshape(-1, *[1] * (load.ndim - 1))


def total_variation(operator: SurfaceOperator, values: Floats) -> float:
    """Return sum_T A_T |G f|_T, with the Frobenius norm over channels.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) or (n, c) float64
    """
    channels = check_length(operator.vertex_count, "vertices", values).reshape(operator.vertex_count, -1)
    return float(_total_variation(operator.faces, operator.hat_gradients, operator.areas, channels))


def gradient_matrix(operator: SurfaceOperator) -> csr_array:
    """Return G as a (2 m, n) sparse matrix; rows 2 f and 2 f + 1 belong to face f."""
    count = len(operator.faces)
    columns = np.repeat(operator.faces, 2, axis=0).ravel()
    entries = operator.hat_gradients.transpose(0, 2, 1).ravel()
    matrix = csr_array((entries, columns, np.arange(0, 6 * count + 1, 3)), shape=(2 * count, operator.vertex_count))
    matrix.sum_duplicates()
    return matrix


def check_length(count: int, what: str, array: Floats) -> Floats:
    """Return `array` as contiguous float64 if it has one entry for each of `count` things, else raise ValueError."""
    array = np.ascontiguousarray(array, dtype=np.float64)
    if len(array) != count:
        raise ValueError(f"array has {len(array)} entries, the operator has {count} {what}")
    return array


@njit(cache=True, nogil=True)
def _gradient(faces: Integers, hats: Floats, values: Floats, result: Floats) -> None:
    for f in range(len(faces)):
        i, j, k = faces[f]
        for c in range(values.shape[1]):
            b, e = values[j, c] - values[i, c], values[k, c] - values[i, c]
            result[f, c, 0] = b * hats[f, 1, 0] + e * hats[f, 2, 0]
            result[f, c, 1] = b * hats[f, 1, 1] + e * hats[f, 2, 1]


@njit(cache=True, nogil=True)
def _adjoint(faces: Integers, hats: Floats, areas: Floats, field: Floats, result: Floats) -> None:
    for f in range(len(faces)):
        i, j, k = faces[f]
        for c in range(field.shape[1]):
            x, y = areas[f] * field[f, c, 0], areas[f] * field[f, c, 1]
            b, e = x * hats[f, 1, 0] + y * hats[f, 1, 1], x * hats[f, 2, 0] + y * hats[f, 2, 1]
            result[j, c] += b
            result[k, c] += e
            result[i, c] -= b + e


@njit(cache=True, nogil=True)
def _total_variation(faces: Integers, hats: Floats, areas: Floats, values: Floats) -> float:
    total = 0.0
    for f in range(len(faces)):
        i, j, k = faces[f]
        square = 0.0
        for c in range(values.shape[1]):
            b, e = values[j, c] - values[i, c], values[k, c] - values[i, c]
            x = b * hats[f, 1, 0] + e * hats[f, 2, 0]
            y = b * hats[f, 1, 1] + e * hats[f, 2, 1]
            square += x * x + y * y
        total += areas[f] * np.sqrt(square)
    return total
