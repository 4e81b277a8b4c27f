"""Straight lines over unfolded triangles, back to where a front came from: paths whose lengths bound distances."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers

# triangles that a line crosses at most
FARTHEST = 1000


@njit(cache=True, nogil=True)
def straighten(
    faces: Integers, lengths: Floats, twins: Integers, sources: Integers, distances: Floats, came: Floats
) -> Floats:
    """Return the length of a path from the sources to each vertex (n,), no longer than those over the sides of faces.

    A path of a vertex is a straight line to a vertex that it sees through the triangles which the line of its front crosses,
    and the path of that one. `distances` order the vertices; `came` (n, 2) are sides and shares of `march`.
    """
    n = len(distances)
    upper = np.full(n, np.inf)
    for s in sources:
        upper[s] = 0.0
    for w in np.argsort(distances):
        if upper[w] == 0.0 or not np.isfinite(distances[w]):
            continue
        side = int(came[w, 0])
        f, k = side // 3, side % 3
        # w lies at 0, the ends of the side at p and q, counterclockwise
        to_p, to_q, base = lengths[f, (k + 2) % 3], lengths[f, (k + 1) % 3], lengths[f, k]
        # corner k + 2 is w: its sides are k + 2 (to corner k) and k + 1 (from corner k + 1)
        px, py = to_p, 0.0
        qx = (to_p * to_p + to_q * to_q - base * base) / (2.0 * to_p)
        qy = np.sqrt(max(to_q * to_q - qx * qx, 0.0))
        best = min(upper[faces[f, k]] + to_p, upper[faces[f, (k + 1) % 3]] + to_q)
        share = came[w, 1]
        dx, dy = px + share * (qx - px), py + share * (qy - py)
        # what is seen lies between these two directions
        rx, ry, lx, ly = px, py, qx, qy
        for _ in range(FARTHEST):
            twin = twins[side]
            if twin < 0:
                break
            g, j = twin // 3, twin % 3
            # the twin runs from q to p; its third corner v lies beyond
            base = lengths[g, j]
            from_p, from_q = lengths[g, (j + 1) % 3], lengths[g, (j + 2) % 3]
            ex, ey = (qx - px) / base, (qy - py) / base
            along = (from_p * from_p + base * base - from_q * from_q) / (2.0 * base)
            height = np.sqrt(max(from_p * from_p - along * along, 0.0))
            vx, vy = px + along * ex + height * ey, py + along * ey - height * ex
            length = np.hypot(vx, vy)
            v = faces[g, (j + 2) % 3]
            right, left = rx * vy - ry * vx >= 0.0, vx * ly - vy * lx >= 0.0
            if right and left:
                best = min(best, upper[v] + length)
            if dx * vy - dy * vx >= 0.0:
                # v lies left of the line, which leaves between p and v: the side from p to v
                side = 3 * g + (j + 1) % 3
                qx, qy = vx, vy
                if left:
                    lx, ly = vx, vy
            else:
                side = 3 * g + (j + 2) % 3
                px, py = vx, vy
                if right:
                    rx, ry = vx, vy
            if min(np.hypot(px, py), np.hypot(qx, qy)) > best:
                break
        upper[w] = best
    return upper
