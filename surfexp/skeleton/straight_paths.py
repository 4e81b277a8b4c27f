"""Straight lines over unfolded triangles, back to where a front came from: paths whose lengths bound distances."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers

# triangles that a line crosses at most
FARTHEST = 1000


@njit(cache=True, nogil=True)
def beyond_sides(faces: Integers, lengths: Floats, twins: Integers) -> tuple[Integers, Floats]:
    """Return what lies beyond each side 3 f + k, which runs from p to q: the third corner of the triangle there, and where.

    Returns
    -------
    (3 m, 3) int64
        The corner v, the side of its triangle from p to v, and that from v to q; v is -1 at the boundary.
    (3 m, 2) float64
        The place of v in the plane of the side: its share along it from p, and its height, over the length of the side.
    """
    corners, places = np.full((len(twins), 3), -1), np.zeros((len(twins), 2))
    for side in range(len(twins)):
        if twins[side] < 0:
            continue
        # the twin runs from q to p
        f, k = twins[side] // 3, twins[side] % 3
        to_p, to_q = (k + 1) % 3, (k + 2) % 3
        base, from_p, from_q = lengths[f, k], lengths[f, to_p], lengths[f, to_q]
        along = (from_p * from_p + base * base - from_q * from_q) / (2.0 * base)
        corners[side, 0], corners[side, 1], corners[side, 2] = faces[f, to_q], 3 * f + to_p, 3 * f + to_q
        places[side, 0] = along / base
        places[side, 1] = np.sqrt(max(from_p * from_p - along * along, 0.0)) / base
    return corners, places


@njit(cache=True, nogil=True)
def straighten(
    order: Integers, upper: Floats, faces: Integers, lengths: Floats, came: Floats, corners: Integers, places: Floats
) -> None:
    """Write the length of a path from the sources to each vertex of `order`, no longer than those over the sides of faces.

    A path of a vertex is a straight line to a vertex that it sees through the triangles which the line of its front crosses,
    and the path of that one. `order` (k,) goes by distance, `upper` (n,) holds the lengths of all vertices before, infinite
    elsewhere; `came` (n, 2) are sides and shares of `march`, `corners` and `places` are those of `beyond_sides`.
    """
    for w in order:
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
            v = corners[side, 0]
            if v < 0:
                break
            along, height = places[side, 0], places[side, 1]
            ex, ey = qx - px, qy - py
            vx, vy = px + along * ex + height * ey, py + along * ey - height * ex
            right, left = rx * vy - ry * vx >= 0.0, vx * ly - vy * lx >= 0.0
            if right and left:
                best = min(best, upper[v] + np.sqrt(vx * vx + vy * vy))
            if dx * vy - dy * vx >= 0.0:
                # v lies left of the line, which leaves between p and v
                side, qx, qy = corners[side, 1], vx, vy
                if left:
                    lx, ly = vx, vy
            else:
                side, px, py = corners[side, 2], vx, vy
                if right:
                    rx, ry = vx, vy
            if min(px * px + py * py, qx * qx + qy * qy) > best * best:
                break
        upper[w] = best
