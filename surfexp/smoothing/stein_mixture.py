"""A convex mixture of filtered maps of least estimated risk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.fitted_trials import Trial
from surfexp.variational.fitted_noise import FittedNoise

# by how much covariances count more than estimated: of many estimates the least is too low, and favours rough results
CAUTION = 1.1
# vertices that say the same, for noise of a full width of one edge
CORRELATED_PER_WIDTH = 1.31


@dataclass(frozen=True, eq=False)
class Mixture:
    """A weighted mean of filtered maps.

    Parameters
    ----------
    values : (n,) float64
    members : tuple of Trial
        The best of each method.
    shares : (k,) float64
        Of the members: not negative, of sum 1.
    risks : (k,) float64
        Estimated mean square error of each member by area, in the squared unit of the map.
    risk, risk_error : float
        The same of the mixture, and its standard error, the noise taken as it was read.
    """

    values: Floats
    members: tuple[Trial, ...]
    shares: Floats
    risks: Floats
    risk: float
    risk_error: float


def stein_mixture(
    operator: SurfaceOperator, values: Floats, noise: FittedNoise, trials: Sequence[Trial], caution: float = CAUTION
) -> Mixture:
    """Mix the best trial of each method so that Stein's estimate of the risk is least.

    The estimate for a result F with response r is ``mean(m ((F - y)^2 + 2 r - s^2))`` by area, outliers left out. It is
    quadratic in the shares of a mixture of filters, and its minimum over the simplex is exact. The choice counts responses
    `caution` times.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) float64
        The map y that was filtered.
    noise : FittedNoise
    trials : sequence of Trial
    caution : float

    References
    ----------
    Stein: Estimation of the mean of a multivariate normal distribution (1981).
    """
    usual = np.ones(len(values), dtype=bool)
    usual[noise.outliers] = False
    area = np.where(usual, operator.mass, 0.0) / operator.mass[usual].sum()
    rests = np.array([trial.values - values for trial in trials])
    covariances = np.array([area @ trial.response for trial in trials])
    squares = np.einsum("kn,n,kn->k", rests, area, rests)
    careful = squares + 2.0 * caution * covariances
    best = [
        min((place for place, one in enumerate(trials) if one.method == method), key=careful.__getitem__)
        for method in dict.fromkeys(trial.method for trial in trials)
    ]
    products = np.einsum("kn,n,ln->kl", rests[best], area, rests[best])
    shares = least_on_simplex(products, caution * covariances[best])
    members = tuple(trials[place] for place in best)
    risks = (squares + 2.0 * covariances)[best] - area @ noise.levels**2
    mixed = shares @ np.array([member.values for member in members])
    response = shares @ np.array([member.response for member in members])
    terms = ((mixed - values) ** 2 + 2.0 * response - noise.levels**2)[usual]
    kept = area[usual]
    alike = max(1.0, CORRELATED_PER_WIDTH * (noise.width / operator.edge_length) ** 2)
    # the mean square of this draw differs from the level by chance, also where a filter leaves all of it
    chance = 2.0 * float(kept**2 @ noise.levels[usual] ** 4)
    risk = float(kept @ terms)
    error = float(np.sqrt(alike * (kept**2 @ (terms - risk) ** 2 + chance)))
    return Mixture(mixed, members, shares, risks, risk, error)


def least_on_simplex(products: Floats, slopes: Floats) -> Floats:
    """Return the shares w >= 0 of sum 1 with the least ``w P w + 2 w c``, by trying every support.

    Parameters
    ----------
    products : (k, k) float64
        P, positive semidefinite; k is small.
    slopes : (k,) float64
        c.
    """
    count = len(slopes)
    best, least = np.zeros(count), np.inf
    for size in range(1, count + 1):
        for support in combinations(range(count), size):
            chosen = list(support)
            system = np.ones((size + 1, size + 1))
            system[:size, :size], system[size, size] = products[np.ix_(chosen, chosen)], 0.0
            found = np.linalg.lstsq(system, np.r_[-slopes[chosen], 1.0], rcond=None)[0][:size]
            shares = np.zeros(count)
            shares[chosen] = found
            energy = float(shares @ products @ shares + 2.0 * shares @ slopes)
            if found.min() >= 0.0 and abs(found.sum() - 1.0) < 1e-9 and energy < least:
                best, least = shares, energy
    return best
