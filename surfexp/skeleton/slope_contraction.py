"""Functions on a triangulation made so flat that no triangle has a slope above 1."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers

ROOTS = np.sqrt(np.array([2.0, 6.0]))
NEWTON_STEPS = 30


@njit(cache=True, nogil=True)
def contract(
    faces: Integers, hats: Floats, start: Integers, star: Integers, values: Floats, goal: float, rounds: int
) -> bool:
    """Project the values of every face steeper than 1 onto those of slope `goal`, in place, in turn; return whether none is left.

    Projections onto convex sets that have a point in common come ever nearer to all of them. `hats` (m, 3, 2) are the
    gradients of the hat functions; the faces of vertex v are star[start[v]:start[v + 1]].
    """
    m = len(faces)
    ring, first, count = np.arange(m), 0, m
    waiting = np.ones(m, np.bool_)
    for _ in range(rounds * m):
        if not count:
            return True
        f = ring[first]
        first = (first + 1) % m
        count -= 1
        waiting[f] = False
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        gx = values[a] * hats[f, 0, 0] + values[b] * hats[f, 1, 0] + values[c] * hats[f, 2, 0]
        gy = values[a] * hats[f, 0, 1] + values[b] * hats[f, 1, 1] + values[c] * hats[f, 2, 1]
        if not 1.0 < gx * gx + gy * gy < np.inf:
            continue
        values[a], values[b], values[c] = _projected(values[a], values[b], values[c], hats[f], goal)
        for k in range(3):
            v = faces[f, k]
            for at in range(start[v], start[v + 1]):
                near = star[at]
                if not waiting[near]:
                    waiting[near] = True
                    ring[(first + count) % m] = near
                    count += 1
    return not count


@njit(cache=True, nogil=True)
def _projected(a: float, b: float, c: float, hats: Floats, goal: float) -> tuple[float, float, float]:
    """The nearest three values whose slope is the goal, and which have the same mean."""
    mean = (a + b + c) / 3.0
    # in the basis (1, -1, 0) / sqrt 2, (1, 1, -2) / sqrt 6 of values with mean 0
    y1, y2 = (a - b) / ROOTS[0], (a + b - 2.0 * c) / ROOTS[1]
    m11, m21 = (hats[0, 0] - hats[1, 0]) / ROOTS[0], (hats[0, 1] - hats[1, 1]) / ROOTS[0]
    m12 = (hats[0, 0] + hats[1, 0] - 2.0 * hats[2, 0]) / ROOTS[1]
    m22 = (hats[0, 1] + hats[1, 1] - 2.0 * hats[2, 1]) / ROOTS[1]
    p, q, r = m11 * m11 + m21 * m21, m12 * m12 + m22 * m22, m11 * m12 + m21 * m22
    angle = 0.5 * np.arctan2(2.0 * r, p - q)
    cosine, sine = np.cos(angle), np.sin(angle)
    large = p * cosine * cosine + q * sine * sine + 2.0 * r * sine * cosine
    small = max(p + q - large, 0.0)
    z1, z2 = cosine * y1 + sine * y2, cosine * y2 - sine * y1
    # large z1^2 / (1 + t large)^2 + small z2^2 / (1 + t small)^2 = goal^2, convex and falling in t
    t = 0.0
    for _ in range(NEWTON_STEPS):
        one, two = large * z1 * z1 / (1.0 + t * large) ** 2, small * z2 * z2 / (1.0 + t * small) ** 2
        excess = one + two - goal * goal
        if excess <= 1e-9:
            break
        t += excess / (2.0 * (one * large / (1.0 + t * large) + two * small / (1.0 + t * small)))
    z1, z2 = z1 / (1.0 + t * large), z2 / (1.0 + t * small)
    y1, y2 = cosine * z1 - sine * z2, cosine * z2 + sine * z1
    return mean + y1 / ROOTS[0] + y2 / ROOTS[1], mean - y1 / ROOTS[0] + y2 / ROOTS[1], mean - 2.0 * y2 / ROOTS[1]
