"""The heat kernel by Chebyshev polynomials of the Laplacian: no factorisation, and a bound of the error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.special import ive

from surfexp.contract.arrays import Floats
from surfexp.linalg.chebyshev_sums import chebyshev_sums
from surfexp.operators.assembly import stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.separable_quadratic import check_positive

LARGEST_DEGREE = 100_000


def heat_polynomial(
    operator: SurfaceOperator, values: Floats, time: float, tolerance: float = 1e-8
) -> tuple[Floats, int, float]:
    """Return exp(-t L) f for L = M^-1 S with the lumped mass M, by the Chebyshev series of the exponential.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) or (n, c) float64
    time : float
        In squared units of length.
    tolerance : float
        Bound of the error over |f|, both in the mass norm.

    Returns
    -------
    like `values`
    int
        Degree of the polynomial, about sqrt(t lambda_max log(1 / tolerance)).
    float
        Bound of the relative error by the terms that are left out; rounding aside.

    Raises
    ------
    ValueError
        If time or tolerance is not positive, or more than 100,000 terms are needed.

    References
    ----------
    Amos: Computation of modified Bessel functions and their ratios (1974), for the bound of what is left out.
    Huang, Lyu, Qiu, Chung: Fast polynomial approximation of heat kernel convolution on manifolds and its application to
    brain sulcal and gyral graph pattern analysis (2020).
    """
    return next(iter(heat_polynomials(operator, values, [time], tolerance)))


def heat_polynomials(
    operator: SurfaceOperator,
    values: Floats,
    times: Sequence[float],
    tolerance: float = 1e-8,
    weights: Floats | None = None,
) -> list[tuple[Floats, int, float]]:
    """Return exp(-t L) f for several times by one recurrence: the series differ in their coefficients alone.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) or (n, c) float64
    times : sequence of float
        At least one, in squared units of length.
    tolerance : float
        As in `heat_polynomial`.
    weights : (n,) float64, optional
        Positive factors of the mass, 1 if not given: where they are small, the map is smoothed more.

    Returns
    -------
    list of (like `values`, int, float)
        What `heat_polynomial` returns, for each time.

    Raises
    ------
    ValueError
        If a time or the tolerance is not positive, or more than 100,000 terms are needed.
    """
    for time in times:
        check_positive("time", time)
    check_positive("tolerance", tolerance)
    largest = largest_eigenvalue_bound(operator, weights)
    series = [_coefficients(0.5 * time * largest, tolerance) for time in times]
    mass = operator.mass if weights is None else operator.mass * weights
    laplacian = csr_array(diags_array(1.0 / mass) @ stiffness(operator))
    totals = chebyshev_sums(laplacian, largest, values, [given for given, _ in series])
    return [(total, len(given) - 1, rest) for total, (given, rest) in zip(totals, series, strict=True)]


def largest_eigenvalue_bound(operator: SurfaceOperator, weights: Floats | None = None) -> float:
    """Return a number that no eigenvalue of the lumped problem exceeds: the largest of single triangles.

    Both forms are sums over triangles, so a Rayleigh quotient is at most the largest quotient of a triangle. Factors of
    the mass may be given, one for each vertex.
    """
    hats = operator.hat_gradients
    if weights is not None:
        hats = hats / np.sqrt(weights[operator.faces])[:, :, None]
    # the nonzero eigenvalues of hats @ hats.T, which is 3 by 3, are those of hats.T @ hats, which is 2 by 2
    x, y = hats[..., 0], hats[..., 1]
    first, mixed, last = (np.einsum("fa,fa->f", one, other) for one, other in ((x, x), (x, y), (y, y)))
    return float(3.0 * (0.5 * (first + last) + np.hypot(0.5 * (first - last), mixed)).max())


def _coefficients(half: float, tolerance: float) -> tuple[Floats, float]:
    """Coefficients of exp(-half (1 + x)) on [-1, 1], and the sum of the moduli of those left out."""
    degree = 8
    while degree <= LARGEST_DEGREE:
        terms = 2.0 * ive(np.arange(degree + 64), half)
        terms[0] *= 0.5
        tails = np.cumsum(terms[::-1])[::-1] + terms[-1] * _rest_over_last(half, degree + 63)
        enough = np.flatnonzero(tails[1:] <= tolerance)
        if len(enough) and enough[0] < degree:
            last = int(enough[0])
            return terms[: last + 1] * (-1.0) ** np.arange(last + 1), float(tails[last + 1])
        degree *= 2
    raise ValueError(
        f"time times the largest eigenvalue is {2 * half:.3g}: more than {LARGEST_DEGREE:,} terms; take heat_flow, "
        "whose steps are implicit"
    )


def _rest_over_last(half: float, last: int) -> float:
    """Bound of the sum of the coefficients beyond the last one over that one: a geometric series.

    By Amos (1974), I_(k+1)(x) / I_k(x) <= x / (k + 1/2 + sqrt(x^2 + (k + 1/2)^2)), which falls with k.
    """
    ratio = half / (last + 0.5 + np.hypot(half, last + 0.5))
    return float(ratio / (1.0 - ratio))
