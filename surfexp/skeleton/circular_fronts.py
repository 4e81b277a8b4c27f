"""Fast marching with fronts that are circles about the source, unfolded into the plane."""

from __future__ import annotations

import heapq

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers


@njit(cache=True, nogil=True)
def march(
    faces: Integers, lengths: Floats, start: Integers, star: Integers, sources: Integers, bends: NDArray[np.bool_]
) -> tuple[Floats, Floats]:
    """Return distances (n,) and where the front came from, (n, 2): a side 3 f + k and the share of it that was crossed, or -1.

    Both ends of a side know the last vertex at which their front began: a source, or one that `bends` paths, (n,) bool. Where
    it is the same one, the circle about its place in the plane of the face gives the third corner; else the plane wave through
    both values does (Kimmel and Sethian 1998). `lengths` (m, 3) are those of the sides from corner k to corner k + 1; the faces
    of vertex v are star[start[v]:start[v + 1]].
    """
    n = len(start) - 1
    distance, fixed = np.full(n, np.inf), np.zeros(n, np.bool_)
    origin, before, came = np.full(n, -1), np.zeros(n), np.full((n, 2), -1.0)
    heap = [(0.0, -1)]
    heap.pop()
    for s in sources:
        distance[s], origin[s] = 0.0, s
        heapq.heappush(heap, (0.0, s))
    while heap:
        key, u = heapq.heappop(heap)
        if fixed[u] or key > distance[u]:
            continue
        fixed[u] = True
        for at in range(start[u], start[u + 1]):
            f = star[at]
            for j in range(3):
                if faces[f, j] != u:
                    continue
                for turn in range(2):
                    third, second = (j + 1 + turn) % 3, (j + 2 - turn) % 3
                    w, o = faces[f, third], faces[f, second]
                    if fixed[w]:
                        continue
                    to_third, to_second = lengths[f, j], lengths[f, (j + 2) % 3]
                    if turn:
                        to_third, to_second = to_second, to_third
                    reached, share = distance[u] + to_third, -1.0
                    centre, elapsed = origin[u], before[u]
                    if bends[u]:
                        centre, elapsed = u, distance[u]
                    if fixed[o]:
                        across = lengths[f, (j + 1) % 3]
                        same, common, since = origin[u] == origin[o], origin[u], before[u]
                        if origin[o] == u:
                            same, common, since = True, u, distance[u]
                        elif origin[u] == o:
                            same, common, since = True, o, distance[o]
                        through, place = _through(
                            distance[u] - since, distance[o] - since, to_third, to_second, across, same
                        )
                        if through + since < reached:
                            reached, share, centre, elapsed = through + since, place, common, since
                    if reached < distance[w]:
                        distance[w], origin[w], before[w] = reached, centre, elapsed
                        # the side opposite of w runs from corner third + 1
                        side = (third + 1) % 3
                        came[w, 0] = 3 * f + side
                        came[w, 1] = max(share, 0.0) if side == j else 1.0 - max(share, 0.0)
                        heapq.heappush(heap, (reached, w))
    return distance, came


@njit(cache=True, nogil=True)
def _through(near: float, far: float, to_third: float, base: float, across: float, same: bool) -> tuple[float, float]:
    """Distance of the third corner through the base, and the share of the base that is crossed; infinite if none is.

    `near` and `far` are those of the ends of the base at 0 and at its length.
    """
    x = (to_third * to_third + base * base - across * across) / (2.0 * base)
    y = np.sqrt(max(to_third * to_third - x * x, 0.0))
    if same:
        px = (near * near - far * far + base * base) / (2.0 * base)
        if near * near >= px * px:
            py = np.sqrt(near * near - px * px)
            if y + py > 0.0:
                crossed = px + (x - px) * py / (y + py)
                if 0.0 <= crossed <= base:
                    return np.hypot(x - px, y + py), crossed / base
            return np.inf, 0.0
    slope = (far - near) / base
    if abs(slope) >= 1.0:
        return np.inf, 0.0
    height = np.sqrt(1.0 - slope * slope)
    crossed = x - slope * y / height
    if not 0.0 <= crossed <= base:
        return np.inf, 0.0
    return near + slope * x + height * y, crossed / base
