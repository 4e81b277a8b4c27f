"""One pass over the faces for each kind of iteration: gradient, pointwise step and adjoint fused, nothing allocated.

Fields have shapes (n, c) and (m, c, 2). Each sweep leaves the load d = G^T A p of the field that it produced. The dual ball
is |p_T|_F <= 1 over the channels of a face together.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers


@njit(cache=True, nogil=True, inline="always")
def _slope(faces: Integers, hats: Floats, f: int, values: Floats, c: int) -> tuple[float, float]:
    """Return the gradient of channel c on face f."""
    first = values[faces[f, 0], c]
    b, e = values[faces[f, 1], c] - first, values[faces[f, 2], c] - first
    return b * hats[f, 1, 0] + e * hats[f, 2, 0], b * hats[f, 1, 1] + e * hats[f, 2, 1]


@njit(cache=True, nogil=True, inline="always")
def _push(faces: Integers, hats: Floats, f: int, x: float, y: float, load: Floats, c: int) -> None:
    """Add to the load of channel c that of the field (x, y), times the area, on face f."""
    b, e = x * hats[f, 1, 0] + y * hats[f, 1, 1], x * hats[f, 2, 0] + y * hats[f, 2, 1]
    load[faces[f, 1], c] += b
    load[faces[f, 2], c] += e
    load[faces[f, 0], c] -= b + e


@njit(cache=True, nogil=True)
def dual_ascent(
    faces: Integers, hats: Floats, areas: Floats, steps: Floats, step: float, values: Floats, dual: Floats, load: Floats
) -> None:
    """Set p <- P(p + step s_T G phi), with P the projection to the unit ball of each face."""
    load[:] = 0.0
    for f in range(len(faces)):
        ascent = step * steps[f]
        square = 0.0
        for c in range(values.shape[1]):
            x, y = _slope(faces, hats, f, values, c)
            x, y = dual[f, c, 0] + ascent * x, dual[f, c, 1] + ascent * y
            dual[f, c, 0], dual[f, c, 1] = x, y
            square += x * x + y * y
        shrink = 1.0 / np.sqrt(max(square, 1.0))
        for c in range(values.shape[1]):
            x, y = shrink * dual[f, c, 0], shrink * dual[f, c, 1]
            dual[f, c, 0], dual[f, c, 1] = x, y
            _push(faces, hats, f, areas[f] * x, areas[f] * y, load, c)


@njit(cache=True, nogil=True)
def bregman_update(
    faces: Integers,
    hats: Floats,
    areas: Floats,
    penalty: float,
    relaxation: float,
    values: Floats,
    field: Floats,
    multiplier: Floats,
    load: Floats,
    pull: Floats,
) -> None:
    """Shrink V as in (2.17) and update b as in (2.14), over-relaxed.

    Leaves `load` = G^T A (penalty b), whose field is dual feasible, and `pull` = G^T A (V - b) for the next solve.
    """
    load[:] = 0.0
    pull[:] = 0.0
    radius = 1.0 / penalty
    for f in range(len(faces)):
        square = 0.0
        for c in range(values.shape[1]):
            x, y = _slope(faces, hats, f, values, c)
            x = relaxation * x + (1.0 - relaxation) * field[f, c, 0] + multiplier[f, c, 0]
            y = relaxation * y + (1.0 - relaxation) * field[f, c, 1] + multiplier[f, c, 1]
            field[f, c, 0], field[f, c, 1] = x, y
            square += x * x + y * y
        inside = radius / max(np.sqrt(square), radius)
        for c in range(values.shape[1]):
            x, y = field[f, c, 0], field[f, c, 1]
            px, py = inside * x, inside * y
            multiplier[f, c, 0], multiplier[f, c, 1] = px, py
            field[f, c, 0], field[f, c, 1] = x - px, y - py
            _push(faces, hats, f, penalty * areas[f] * px, penalty * areas[f] * py, load, c)
            _push(faces, hats, f, areas[f] * (x - 2.0 * px), areas[f] * (y - 2.0 * py), pull, c)


@njit(cache=True, nogil=True)
def face_steps(hats: Floats) -> Floats:
    """Return s_T = 1 / (3 c_T), c_T the largest eigenvalue of sum_k g_k g_k^T.

    With dual steps sigma s_T and primal steps tau / m_i, sigma tau <= 1 suffices for convergence, for then
    sum_T A_T s_T |G f|^2 <= sum_T A_T / 3 sum_k f_k^2 = |f|_m^2.

    Parameters
    ----------
    hats : (m, 3, 2) float64

    Returns
    -------
    (m,) float64
    """
    steps = np.empty(len(hats))
    for f in range(len(hats)):
        xx, xy, yy = 0.0, 0.0, 0.0
        for k in range(3):
            xx += hats[f, k, 0] * hats[f, k, 0]
            xy += hats[f, k, 0] * hats[f, k, 1]
            yy += hats[f, k, 1] * hats[f, k, 1]
        steps[f] = 2.0 / (3.0 * (xx + yy + np.sqrt((xx - yy) ** 2 + 4.0 * xy * xy)))
    return steps


@njit(cache=True, nogil=True)
def chambolle_step(
    faces: Integers, hats: Floats, areas: Floats, steps: Floats, step: float, values: Floats, dual: Floats, load: Floats
) -> None:
    """Set p <- (p + s G phi) / (1 + s |G phi|) with s = step s_T, (2.26) for p = -V."""
    load[:] = 0.0
    for f in range(len(faces)):
        ascent = step * steps[f]
        square = 0.0
        for c in range(values.shape[1]):
            x, y = _slope(faces, hats, f, values, c)
            dual[f, c, 0] += ascent * x
            dual[f, c, 1] += ascent * y
            square += x * x + y * y
        shrink = 1.0 / (1.0 + ascent * np.sqrt(square))
        for c in range(values.shape[1]):
            x, y = shrink * dual[f, c, 0], shrink * dual[f, c, 1]
            dual[f, c, 0], dual[f, c, 1] = x, y
            _push(faces, hats, f, areas[f] * x, areas[f] * y, load, c)


@njit(cache=True, nogil=True)
def fista_step(
    faces: Integers,
    hats: Floats,
    areas: Floats,
    steps: Floats,
    step: float,
    momentum: float,
    values: Floats,
    dual: Floats,
    ahead: Floats,
    load: Floats,
) -> float:
    """Set p_new = P(q + step s_T G phi), q = p_new + momentum (p_new - p); `ahead` is q and `load` belongs to it.

    Returns the inner product of the two last moves, positive when the momentum should be dropped.
    """
    load[:] = 0.0
    turn = 0.0
    for f in range(len(faces)):
        ascent = step * steps[f]
        square = 0.0
        for c in range(values.shape[1]):
            x, y = _slope(faces, hats, f, values, c)
            x, y = ahead[f, c, 0] + ascent * x, ahead[f, c, 1] + ascent * y
            square += x * x + y * y
        shrink = 1.0 / np.sqrt(max(square, 1.0))
        for c in range(values.shape[1]):
            x, y = _slope(faces, hats, f, values, c)
            x, y = shrink * (ahead[f, c, 0] + ascent * x), shrink * (ahead[f, c, 1] + ascent * y)
            dx, dy = x - dual[f, c, 0], y - dual[f, c, 1]
            turn += areas[f] / steps[f] * ((ahead[f, c, 0] - x) * dx + (ahead[f, c, 1] - y) * dy)
            dual[f, c, 0], dual[f, c, 1] = x, y
            x, y = x + momentum * dx, y + momentum * dy
            ahead[f, c, 0], ahead[f, c, 1] = x, y
            _push(faces, hats, f, areas[f] * x, areas[f] * y, load, c)
    return turn


@njit(cache=True, nogil=True)
def smoothed_normals(
    faces: Integers, hats: Floats, areas: Floats, smoothing: float, values: Floats, dual: Floats, load: Floats
) -> None:
    """Set p = G phi / sqrt(|G phi|^2 + smoothing^2), the gradient of the regularised total variation."""
    load[:] = 0.0
    for f in range(len(faces)):
        square = smoothing * smoothing
        for c in range(values.shape[1]):
            x, y = _slope(faces, hats, f, values, c)
            dual[f, c, 0], dual[f, c, 1] = x, y
            square += x * x + y * y
        length = np.sqrt(square)
        for c in range(values.shape[1]):
            x, y = dual[f, c, 0] / length, dual[f, c, 1] / length
            dual[f, c, 0], dual[f, c, 1] = x, y
            _push(faces, hats, f, areas[f] * x, areas[f] * y, load, c)
