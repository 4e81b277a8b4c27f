"""When the alternation between regions and their means ends, and why."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.variational.solution import Solution

SETTLED = 1e-4
SAME = 1e-12


class MeanUpdates:
    """The means for which the convex problem was solved, one after the other.

    The alternation has settled when an update moves no mean by more than 1e-4 of the range of the image; it repeats when
    the means are those of an earlier update.

    Parameters
    ----------
    spread : float
        Range of the image.
    limit : int
        Largest number of convex problems.
    """

    def __init__(self, spread: float, limit: int):
        self._spread, self._limit = spread, limit
        self._solved: list[Floats] = []
        self._change = np.inf
        self._period = 0

    def again(self, means: Floats) -> bool:
        """Whether the convex problem is to be solved for these means; if so they count as solved."""
        distances = [float(np.abs(means - former).max()) for former in self._solved]
        if distances:
            self._change = distances[-1]
            bounds = [SAME * self._spread] * (len(distances) - 1) + [SETTLED * self._spread]
            near = [at for at, distance in enumerate(distances) if distance <= bounds[at]]
            self._period = len(distances) - near[-1] if near else 0
        if self._period or len(self._solved) == self._limit:
            return False
        self._solved.append(means)
        return True

    def judge(self, solution: Solution) -> Solution:
        """Return the last solution with the reason why the alternation ended, and the number of updates."""
        count, settled = len(self._solved), self._period == 1
        if settled:
            reason = solution.reason
        elif self._period:
            reason = f"the means repeat with period {self._period} after {count} updates"
        else:
            reason = f"the means still change after {count} updates, by {self._change / self._spread:.1e} of the range"
        if not settled and not solution.converged:
            reason = f"{reason}; in the last convex problem: {solution.reason}"
        return replace(
            solution,
            converged=solution.converged and settled,
            reason=reason,
            metrics=solution.metrics | {"updates": float(count)},
        )
