"""How strongly to smooth, read from the data alone: Stein's risk, the discrepancy principle, and hold-out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.variational.separable_quadratic import check_positive

Rule = Literal["hold_out", "stein", "discrepancy"]
RULES: tuple[Rule, ...] = ("hold_out", "stein", "discrepancy")
# steps of the probe in noise levels: above what solvers leave open, below what the noise does
PROBE_STEP = 0.3

Smoother = Callable[[Floats, float], Floats]


@dataclass(frozen=True, eq=False)
class SmoothedMaps:
    """Repetitions of a map, smoothed with every parameter, and what each rule reads from them.

    Parameters
    ----------
    parameters : (p,) float64
    values : (p, n, r) float64
        Each repetition smoothed by itself.
    stein : (p,) float64
        Stein's estimate of the mean square error of the first repetition, by area.
    removed : (p,) float64
        Root mean square by area of what was removed from it.
    hold_out : (p,) float64
        Mean square by area between each smoothed repetition and the others as they are; NaN for a single one.
    noise : float
        Standard deviation that the rules took.
    """

    parameters: Floats
    values: Floats
    stein: Floats
    removed: Floats
    hold_out: Floats
    noise: float

    def chosen(self, rule: Rule) -> int:
        """Return the place of the parameter that a rule chooses.

        Parameters
        ----------
        rule : {"hold_out", "stein", "discrepancy"}
            The least error on the other repetitions, the least of Stein's estimates, or what removes most without removing
            more than the noise (the least of all where each removes more).

        Raises
        ------
        ValueError
            If the rule is unknown, or a single repetition is to be held out.
        """
        if rule == "hold_out":
            if np.isnan(self.hold_out).all():
                raise ValueError("hold_out needs at least 2 repetitions of the map, it has 1: choose stein")
            return int(np.argmin(self.hold_out))
        if rule == "stein":
            return int(np.argmin(self.stein))
        if rule == "discrepancy":
            allowed = self.removed <= self.noise
            return int(np.argmax(np.where(allowed, self.removed, -self.removed)))
        raise ValueError(f"rule is {rule!r}, choose {', '.join(RULES)}")


def smooth_on_grid(
    smoother: Smoother, maps: Floats, parameters: Sequence[float], mass: Floats, noise: float, seed: int = 0
) -> SmoothedMaps:
    """Smooth repetitions of a map with every parameter of a grid, and collect what the rules need.

    Stein's estimate for independent noise of one standard deviation s at the vertices, with masses m of sum A:
    ``|F(y) - y|^2 / A - s^2 + 2 s^2 / A sum_i m_i dF_i/dy_i``. The sum of derivatives is found by one probe: a map b of
    random signs, ``sum_i m_i b_i (F(y + e b) - F(y))_i / e`` with e = 0.3 s.

    Parameters
    ----------
    smoother : callable
        Takes (n, c) maps and a parameter, smooths each column by itself.
    maps : (n, r) float64
        Repetitions with the same truth.
    parameters : sequence of float
    mass : (n,) float64
    noise : float
        Standard deviation of the noise.
    seed : int
        Of the probe.

    Raises
    ------
    ValueError
        If there is no parameter, or the noise is not positive.

    References
    ----------
    Stein: Estimation of the mean of a multivariate normal distribution (1981).
    Ramani et al.: Monte-Carlo SURE: a black-box optimization of regularization parameters (2008).
    """
    check_positive("noise", noise)
    if not len(parameters):
        raise ValueError("the grid of parameters is empty, at least 1 is needed")
    area, repetitions = float(mass.sum()), maps.shape[1]
    signs = np.random.default_rng(seed).choice([-1.0, 1.0], len(maps))
    step = PROBE_STEP * noise
    columns = np.column_stack([maps, maps[:, 0] + step * signs])
    values = np.empty((len(parameters), *maps.shape))
    stein, removed, hold_out = (np.full(len(parameters), np.nan) for _ in range(3))
    for place, parameter in enumerate(parameters):
        smoothed = smoother(columns, parameter)
        values[place], moved = smoothed[:, :repetitions], smoothed[:, repetitions]
        first = values[place][:, 0]
        squares = float(mass @ (first - maps[:, 0]) ** 2 / area)
        divergence = float(mass @ (signs * (moved - first)) / step)
        removed[place] = np.sqrt(squares)
        stein[place] = squares - noise**2 + 2.0 * noise**2 * divergence / area
        if repetitions > 1:
            hold_out[place] = _hold_out(values[place], maps, mass)
    return SmoothedMaps(np.asarray(parameters, dtype=np.float64), values, stein, removed, hold_out, noise)


def _hold_out(smoothed: Floats, maps: Floats, mass: Floats) -> float:
    """Mean over all pairs of a smoothed repetition and another one as it is."""
    errors = [
        float(mass @ (smoothed[:, first] - maps[:, second]) ** 2)
        for first in range(maps.shape[1])
        for second in range(maps.shape[1])
        if first != second
    ]
    return float(np.mean(errors) / mass.sum())
