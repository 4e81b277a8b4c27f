"""Stein's estimate of the risk of the ROF model, at every weight of a path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.smoothing.fitted_smoothing import HEAVY, tails
from surfexp.smoothing.fitted_trials import Trial
from surfexp.smoothing.parameter_choice import PROBE_STEP
from surfexp.smoothing.stein_mixture import stein_mixture
from surfexp.variational.fitted_noise import FittedNoise
from surfexp.variational.noise_reading import read_noise
from surfexp.variational.own_unit import odd_sign
from surfexp.variational.rof_path import RofPath
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual

# of the gap of the path: a response is a small difference of two solves
OF_GAP = 0.05


@dataclass(frozen=True, eq=False)
class PathRisk:
    """What is known of the risk along a path, in the map's own unit.

    Parameters
    ----------
    path : RofPath
    noise : FittedNoise
    responses : (k, n) float64
        Of each solved weight: probe times the change of the minimiser with it.
    """

    path: RofPath
    noise: FittedNoise
    responses: Floats

    def at(self, mu: float) -> tuple[float, float]:
        """Return the estimated mean square error by area of the interpolated minimiser, and its standard error.

        The response of the interpolated map is that of its two ends, interpolated.

        Parameters
        ----------
        mu : float
            Within the range.

        Returns
        -------
        (float, float)
            Over the variance of the noise.
        """
        found = stein_mixture(self.path.operator, self._target, self.noise, [self._trial(mu)])
        return found.risk / self.noise.level**2, found.risk_error / self.noise.level**2

    def has_heavy_tails(self, mu: float) -> bool:
        """Whether what is removed at a weight has tails for which no estimate holds.

        Parameters
        ----------
        mu : float
            Within the range.
        """
        return tails(self._target - self._trial(mu).values, self.noise)[1] > HEAVY

    @cached_property
    def _target(self) -> Floats:
        return self.path.own.normalised(self.path.image)

    def _trial(self, mu: float) -> Trial:
        place, t = self.path.place(mu)
        before, after = self.path.knots[place], self.path.knots[place + 1]
        values = self._target + (1.0 - t) * before.difference + t * after.difference
        response = (1.0 - t) * self.responses[place] + t * self.responses[place + 1]
        return Trial("total_variation", mu, values, response, at_the_end=False)


def path_risk(path: RofPath, level: float, seed: int = 0, known: FittedNoise | None = None) -> PathRisk:
    """Solve the map with a probe at each solved weight, and keep how the minimisers respond.

    The probe b is drawn from the noise that is read from the map, and the response is ``b (F(y + e b) - F(y)) / e`` with
    e = 0.3, as for the automatic choice.

    Parameters
    ----------
    path : RofPath
        Of one channel.
    level : float
        Standard deviation of the noise, in the unit of the map.
    seed : int
        Of the probe.
    known : FittedNoise, optional
        In the unit of the map, such as that of two measurements; read from the map if not given.

    Returns
    -------
    PathRisk

    References
    ----------
    Stein: Estimation of the mean of a multivariate normal distribution (1981). Ramani et al.: Monte-Carlo SURE (2008).
    """
    operator, target = path.operator, path.own.normalised(path.image)
    kind = read_noise(operator, target, level=level / path.own.unit) if known is None else known
    noise = kind.with_level(level / path.own.unit)
    probe = odd_sign(target) * noise.draw(operator, seed)
    probed = target + PROBE_STEP * probe
    tolerance = OF_GAP * path.largest_gap
    responses = np.empty((len(path.knots), len(target)))
    last: Solution | None = None
    before = path.knots[-1].solution
    for place, knot in reversed([*enumerate(path.knots)]):
        data = rof(operator.mass, probed, knot.mu)
        start = knot.solution if last is None else _moved(knot.solution, before, last)
        last, before = primal_dual(data, operator, start, tolerance=tolerance, iteration_limit=100_000), knot.solution
        responses[place] = probe * (last.values - knot.solution.values) / PROBE_STEP
    return PathRisk(path, noise, responses)


def _moved(solution: Solution, before: Solution, last: Solution) -> Solution:
    """A start for the map with the probe: the solution for the map, moved as that of the weight before was."""
    assert solution.dual is not None and before.dual is not None and last.dual is not None  # noqa: S101, narrows types
    return replace(
        solution, values=solution.values + last.values - before.values, dual=solution.dual + last.dual - before.dual
    )
