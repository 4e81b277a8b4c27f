"""Lagrange elements of order 1, 2 and 3 on the reference triangle: nodes, basis and quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import roots_jacobi, roots_legendre

from surfexp.contract.arrays import Floats

ORDERS = (1, 2, 3)


@dataclass(frozen=True, eq=False)
class LagrangeElement:
    """Polynomials of one order on the triangle (0,0), (1,0), (0,1), and a quadrature that integrates their products.

    Parameters
    ----------
    order : int
    nodes : (b, 3) float64
        Barycentric coordinates: the corners, then order - 1 nodes on each of the sides (0,1), (1,2), (2,0) from the
        first corner to the second, then the inner ones.
    weights : (q,) float64
        Quadrature weights; they sum to 1/2.
    points : (q, 2) float64
        Quadrature points (x, y), barycentric (1-x-y, x, y).
    basis : (q, b) float64
        The function of each node at each point: 1 at its own node, 0 at the others.
    gradients : (q, b, 2) float64
        Its derivatives by x and y.
    """

    order: int
    nodes: Floats
    weights: Floats
    points: Floats
    basis: Floats
    gradients: Floats


def lagrange_element(order: int) -> LagrangeElement:
    """Return the Lagrange element of an order.

    Raises
    ------
    ValueError
        If the order is not 1, 2 or 3.
    """
    if order not in ORDERS:
        raise ValueError(f"element order {order} is unknown, choose 1, 2 or 3")
    nodes = lagrange_nodes(order)
    points, weights = triangle_quadrature(order + 2)
    powers = np.array([(i, j) for i in range(order + 1) for j in range(order + 1 - i)])
    coefficients = np.linalg.inv(_monomials(nodes[:, 1:], powers))
    slopes = []
    for axis in range(2):
        lowered = powers.copy()
        lowered[:, axis] = np.maximum(lowered[:, axis] - 1, 0)
        slopes.append((_monomials(points, lowered) * powers[:, axis]) @ coefficients)
    return LagrangeElement(
        order, nodes, weights, points, _monomials(points, powers) @ coefficients, np.stack(slopes, axis=-1)
    )


def lagrange_nodes(order: int) -> Floats:
    """(b, 3) barycentric coordinates of the nodes: corners, sides, inside."""
    nodes = [(order, 0, 0), (0, order, 0), (0, 0, order)]
    for start, end in ((0, 1), (1, 2), (2, 0)):
        for step in range(1, order):
            node = [0, 0, 0]
            node[start], node[end] = order - step, step
            nodes.append((node[0], node[1], node[2]))
    nodes += [(order - i - j, i, j) for i in range(1, order) for j in range(1, order - i)]
    return np.array(nodes) / order


def triangle_quadrature(count: int) -> tuple[Floats, Floats]:
    """(count^2, 2) points and weights on the reference triangle, exact to degree 2 count - 1 (collapsed Gauss-Jacobi)."""
    x, x_weights = roots_legendre(count)
    y, y_weights = roots_jacobi(count, 1.0, 0.0)
    x, y = 0.5 * (x + 1.0)[:, None], 0.5 * (y + 1.0)[None, :]
    points = np.stack([(x * (1.0 - y)).ravel(), np.broadcast_to(y, (count, count)).ravel()], axis=1)
    return points, (0.5 * x_weights[:, None] * (0.25 * y_weights)[None, :]).ravel()


def _monomials(points: Floats, powers: np.ndarray) -> Floats:
    return points[:, :1] ** powers[:, 0] * points[:, 1:] ** powers[:, 1]
