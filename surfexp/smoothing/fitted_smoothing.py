"""Which filters and how strongly, by Stein's risk for the noise that was read from the map."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.fitted_trials import fitted_trials
from surfexp.smoothing.stein_mixture import CAUTION, Mixture, stein_mixture
from surfexp.variational.fidelity import Progress
from surfexp.variational.fitted_noise import ROUGH, FittedNoise
from surfexp.variational.noise_level import NORMAL_MEDIAN
from surfexp.variational.noise_reading import read_noise, without_outliers
from surfexp.variational.own_unit import odd_sign, own_unit

# root mean square of what is removed over its deviation by the median: 1 for normal noise, 1.26 for a Laplace distribution
HEAVY = 1.1
CAPPED_AT = 5.0
# deviations beyond which values with heavy tails are drawn towards the smoothed map, and how often
DRAWN_FROM, PASSES = 1.5, 2
CAUTION_OF_PILOT = 1.3


@dataclass(frozen=True, eq=False)
class FittedSmoothing:
    """A map smoothed by a mixture of filters.

    Parameters
    ----------
    mixture : Mixture
        Values in the unit of the map, risks over the variance of the noise. Where values were drawn in, risks say nothing.
    noise : FittedNoise
        As read from the map.
    heaviness : float
        Root mean square of what a first mixture removes, over its deviation by the median: 1 for normal noise.
    drawn_in : int
        How many values were drawn towards the smoothed map.
    largest_gap : float
        Of all minimisations, relative.
    error_bound : float
        Largest possible root mean square distance by area of the result to the exact mixture of minimisers, in the unit of
        the map.
    converged : bool
    """

    mixture: Mixture
    noise: FittedNoise
    heaviness: float
    drawn_in: int
    largest_gap: float
    error_bound: float
    converged: bool


def fitted_smoothing(
    operator: SurfaceOperator,
    values: Floats,
    level: float | None = None,
    tolerance: float = 1e-3,
    known: FittedNoise | None = None,
    threads: int = 1,
    progress: Progress | None = None,
) -> FittedSmoothing:
    """Smooth a map by the mixture of heat kernel, total variation and edge-weighted total variation of least risk.

    Outliers are replaced before: of noise that is known, those that this map has too. Where what is removed has heavy tails,
    values far from the smoothed map are drawn towards it, to 1.5 deviations, and the map that results is smoothed in its
    place: Stein's estimate holds for normal noise. A map that is rough itself leaves much of itself in the rest: its values
    are left where they are, and the choice is not cautious.

    Parameters
    ----------
    operator : SurfaceOperator
        Consistent.
    values : (n,) float64
    level : float, optional
        Standard deviation of the noise; read from the map if not given.
    tolerance : float
        Of the relative gap of total variation.
    known : FittedNoise, optional
        In the unit of the map, as read from two measurements; where values are drawn in, only its level is read again.
    threads : int
        As in `fitted_trials`; the bytes are the same.
    progress : callable, optional
        Receives the iteration and the gap of one minimisation after the other.

    Raises
    ------
    ValueError
        If the noise is not positive.

    References
    ----------
    Stein: Estimation of the mean of a multivariate normal distribution (1981).
    Cox: Asymptotics for M-type smoothing splines (1983), for values that are drawn in.
    """
    trials_of = partial(fitted_trials, operator, tolerance=tolerance, threads=threads, progress=progress)
    own = own_unit(values)
    sign = odd_sign(own.normalised(values))
    unit = sign * own.normalised(values)
    given = None if level is None else level / own.unit
    read = read_noise(operator, unit, level=given)
    noise = read if known is None else known.in_unit(1.0 / own.unit)
    # where measurements differ the other one may be far off, and where both are, it is the map
    noise = replace(noise, outliers=np.intersect1d(noise.outliers, read.outliers))
    target = noise.level if given is None else given
    if not target > 0:
        raise ValueError(f"noise is {target:g}, it must be positive: give the noise of the map")
    factor = target / read.level if read.level > 0 else 1.0
    noise = noise.with_level(target)
    plain = without_outliers(operator, unit, noise.outliers)
    trials = list(trials_of(plain, noise))
    rough = noise.growth > ROUGH
    mixture, drawn = stein_mixture(operator, plain, noise, trials, 1.0 if rough else CAUTION), 0
    heaviness = tails(plain - mixture.values, noise)[1]
    if heaviness > HEAVY and not noise.step and not rough:
        mixture = stein_mixture(operator, plain, noise, trials, CAUTION_OF_PILOT)
        for _ in range(PASSES):
            rest = plain - mixture.values
            bounds = DRAWN_FROM * tails(rest, noise)[0] * noise.levels
            drawn = int((np.abs(rest) > bounds).sum())
            nearer = mixture.values + np.clip(rest, -bounds, bounds)
            again = read_noise(operator, nearer, level=target)
            again = (again if known is None else noise).with_level(factor * again.level)
            trials = list(trials_of(nearer, again))
            mixture = stein_mixture(operator, nearer, again, trials)
    solutions = [one.solution for one in trials if one.solution is not None]
    bounds_of = [0.0 if one.solution is None else one.solution.error_bound or 0.0 for one in mixture.members]
    return FittedSmoothing(
        replace(
            mixture,
            values=own.restored(sign * mixture.values),
            risks=mixture.risks / target**2,
            risk=mixture.risk / target**2,
            risk_error=mixture.risk_error / target**2,
        ),
        noise.in_unit(own.unit),
        heaviness,
        drawn,
        max(np.inf if one.relative_gap is None else one.relative_gap for one in solutions),
        own.unit * float(mixture.shares @ np.array(bounds_of) / np.sqrt(operator.mass.sum())),
        all(one.converged for one in solutions),
    )


def tails(rest: Floats, noise: FittedNoise) -> tuple[float, float]:
    """Return the deviation by the median of what is removed, in levels, and its root mean square over that.

    Parameters
    ----------
    rest : (n,) float64
        What is removed.
    noise : FittedNoise
    """
    usual = np.ones(len(rest), dtype=bool)
    usual[noise.outliers] = False
    sizes = np.abs(rest / noise.levels)[usual]
    deviation = float(np.median(sizes)) / NORMAL_MEDIAN
    if deviation == 0:
        return 0.0, 1.0
    return deviation, float(np.sqrt((np.minimum(sizes, CAPPED_AT * deviation) ** 2).mean())) / deviation
