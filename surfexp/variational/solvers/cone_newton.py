"""Face loops of a primal-dual interior point method for |G phi| <= t, |p| <= 1.

On the central path t - G phi . p = nu and t p = G phi on every face. A Newton step eliminates dp and dt face by face; what
is left is (mu M + G^T A C G) dphi = rhs with a symmetric C >= 0.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats


@njit(cache=True, nogil=True)
def curvature_blocks(hats: Floats, areas: Floats, slack: Floats, grad: Floats, dual: Floats) -> tuple[Floats, Floats]:
    """Return C (m, 3: xx, xy, yy), symmetrised, and the element matrices A g C g^T (m, 3, 3).

    C = (1 - p w^T / (1 + p . u)) / t with u = G phi / t and w = p + u.
    """
    count = len(areas)
    blocks, local = np.empty((count, 3)), np.empty((count, 3, 3))
    for f in range(count):
        t, px, py = slack[f], dual[f, 0], dual[f, 1]
        wx, wy = px + grad[f, 0] / t, py + grad[f, 1] / t
        share = 1.0 / (t * (1.0 + (px * grad[f, 0] + py * grad[f, 1]) / t))
        xx, yy = 1.0 / t - share * px * wx, 1.0 / t - share * py * wy
        xy = -0.5 * share * (px * wy + py * wx)
        blocks[f, 0], blocks[f, 1], blocks[f, 2] = xx, xy, yy
        for a in range(3):
            x = areas[f] * (hats[f, a, 0] * xx + hats[f, a, 1] * xy)
            y = areas[f] * (hats[f, a, 0] * xy + hats[f, a, 1] * yy)
            for b in range(3):
                local[f, a, b] = x * hats[f, b, 0] + y * hats[f, b, 1]
    return blocks, local


@njit(cache=True, nogil=True)
def residual_fields(
    nu: float, slack: Floats, grad: Floats, dual: Floats, moves: tuple[Floats, Floats, Floats]
) -> tuple[Floats, Floats]:
    """Return dp and dt for dphi = 0; `moves` (dt, d grad, dp) of the round before give the second-order term."""
    base, rest = np.empty_like(dual), np.empty_like(slack)
    slack_move, grad_move, dual_move = moves
    for f in range(len(slack)):
        t, px, py, gx, gy = slack[f], dual[f, 0], dual[f, 1], grad[f, 0], grad[f, 1]
        cross = grad_move[f, 0] * dual_move[f, 0] + grad_move[f, 1] * dual_move[f, 1]
        scalar = nu - t + gx * px + gy * py + cross
        x = t * px - gx + slack_move[f] * dual_move[f, 0]
        y = t * py - gy + slack_move[f] * dual_move[f, 1]
        rest[f] = (scalar - (gx * x + gy * y) / t) / (1.0 + (px * gx + py * gy) / t)
        base[f, 0] = -(px * rest[f] + x) / t
        base[f, 1] = -(py * rest[f] + y) / t
    return base, rest


@njit(cache=True, nogil=True)
def face_moves(
    slack: Floats, grad: Floats, dual: Floats, blocks: Floats, grad_move: Floats, base: Floats, rest: Floats
) -> tuple[Floats, Floats, float, float]:
    """Return dt, dp for a change of the gradient, and the longest steps that keep |G phi| <= t and |p| <= 1."""
    slack_move, dual_move = np.empty_like(slack), np.empty_like(dual)
    cone_step, ball_step = 1e300, 1e300
    for f in range(len(slack)):
        t, px, py, gx, gy = slack[f], dual[f, 0], dual[f, 1], grad[f, 0], grad[f, 1]
        dx, dy = grad_move[f, 0], grad_move[f, 1]
        along = (px + gx / t) * dx + (py + gy / t) * dy
        dt = rest[f] + along / (1.0 + (px * gx + py * gy) / t)
        qx = base[f, 0] + blocks[f, 0] * dx + blocks[f, 1] * dy
        qy = base[f, 1] + blocks[f, 1] * dx + blocks[f, 2] * dy
        slack_move[f], dual_move[f, 0], dual_move[f, 1] = dt, qx, qy
        gap = t * t - gx * gx - gy * gy
        cone_step = min(cone_step, _root(dt * dt - dx * dx - dy * dy, t * dt - gx * dx - gy * dy, gap))
        ball_step = min(ball_step, _root(-qx * qx - qy * qy, -px * qx - py * qy, 1.0 - px * px - py * py))
    return slack_move, dual_move, cone_step, ball_step


@njit(cache=True, nogil=True)
def _root(a: float, b: float, c: float) -> float:
    """Return the least s >= 0 with a s^2 + 2 b s + c = 0, infinite if there is none; 0 where rounding left c <= 0."""
    if c <= 0.0:
        return 0.0
    discriminant = b * b - a * c
    if discriminant < 0.0 or (a >= 0.0 and b >= 0.0):
        return 1e300
    return c / (np.sqrt(discriminant) - b)


@njit(cache=True, nogil=True)
def complementarity(areas: Floats, slack: Floats, grad: Floats, dual: Floats) -> float:
    """Return sum A (t - G phi . p) / sum A, the nu of the iterate."""
    total, area = 0.0, 0.0
    for f in range(len(areas)):
        total += areas[f] * (slack[f] - grad[f, 0] * dual[f, 0] - grad[f, 1] * dual[f, 1])
        area += areas[f]
    return total / area
