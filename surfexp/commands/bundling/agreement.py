"""Whether a result that was made again is the one of before: by its digest, else by what both prove, else to rounding."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import singledispatch
from typing import Any, Literal

import numpy as np

from surfexp.embedding.distance import Distance
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.variational.solution import Solution

State = Literal["same", "within certificates", "within rounding", "differs"]
# by which bounds may miss each other that were computed with rounding, and numbers that nothing is proved about, relatively
BOUND_SLACK, ROUNDING = 1e-12, 1e-9
Interval = tuple[float, float]


@dataclass(frozen=True)
class Agreement:
    """How a result stands to the one of before, and by what it was judged.

    Parameters
    ----------
    state : str
        "same": equal digests. "within certificates": what both prove can be true of one exact number. "within rounding":
        nothing is proved, and the numbers agree to a relative 1e-9. Else "differs".
    reason : str
        The number that decided.
    """

    state: State
    reason: str = ""

    @property
    def holds(self) -> bool:
        """Whether the result counts as the one of before."""
        return self.state != "differs"


@singledispatch
def proved(result: Any) -> dict[str, Interval]:
    """Return the intervals in which a result proves exact numbers to lie, by name; none where it proves nothing.

    Parameters
    ----------
    result : dataclass
        Of a stage.

    Returns
    -------
    dict of str to (float, float)

    Examples
    --------
    >>> import numpy as np
    >>> proved(Solution(np.zeros(3), 2.0, lower_bound=1.5))
    {'least energy': (1.5, 2.0)}
    """
    return {}


@proved.register
def _of_solution(solution: Solution) -> dict[str, Interval]:
    """The least energy lies between the dual energy and the energy that was reached."""
    if solution.lower_bound is None:
        return {}
    return {"least energy": (solution.lower_bound, solution.energy)}


@proved.register
def _of_eigensystem(system: EigenSystem) -> dict[str, Interval]:
    """Each eigenvalue lies within its residual of the value found, where it is proved that none is missing.

    The residual's norm is Euclidean, so that this is right up to the root of the mass matrix's condition number; a
    Rayleigh quotient misses its eigenvalue by the square of the residual, far less.
    """
    if not system.complete:
        return {}
    radii = system.residuals * np.maximum(np.abs(system.values), system.spacing)
    pairs = zip(system.values, radii, strict=True)
    return {
        f"eigenvalue {k}": (float(value - radius), float(value + radius)) for k, (value, radius) in enumerate(pairs)
    }


@proved.register
def _of_distance(distance: Distance) -> dict[str, Interval]:
    """The least distance lies between its lower bound and the one that was found."""
    return {"least distance": (distance.lower_bound, distance.value)}


def agreement(before: Any, again: Any, digests: tuple[str, str] = ("", " ")) -> Agreement:
    """Hold a result against the one of before.

    Parameters
    ----------
    before, again : dataclass
        Results of one stage.
    digests : tuple of str
        Of both, by `content_digest`; equal ones end the comparison.

    Returns
    -------
    Agreement

    Examples
    --------
    Both gaps allow a least energy of 1.8 to 1.9, though neither was reached by the same steps:

    >>> import numpy as np
    >>> before = Solution(np.zeros(3), 2.0, lower_bound=1.5)
    >>> agreement(before, Solution(np.ones(3), 1.9, lower_bound=1.8)).state
    'within certificates'
    >>> agreement(before, Solution(np.ones(3), 3.0, lower_bound=2.5)).reason
    'least energy in [2.5, 3], before in [1.5, 2]'
    """
    if digests[0] == digests[1]:
        return Agreement("same")
    if type(before) is not type(again):
        return Agreement("differs", f"a {type(again).__name__}, before a {type(before).__name__}")
    for name in ("converged", "complete", "optimal"):
        if (now := getattr(again, name, None)) != (then := getattr(before, name, None)):
            return Agreement("differs", f"{name} is {now}, before {then}")
    then, now = proved(before), proved(again)
    return _of_intervals(then, now) if then and now else _of_numbers(before, again)


def content_digest(record: Mapping[str, Any]) -> str:
    """Return the SHA-256 of what a stored record says of its result, without the key that it has.

    Parameters
    ----------
    record : mapping
        Of `store.read_record`.
    """
    text = json.dumps([record["kind"], record["arrays"], record["result"]], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _of_intervals(then: Mapping[str, Interval], now: Mapping[str, Interval]) -> Agreement:
    if then.keys() != now.keys():
        return Agreement("differs", f"{len(now)} numbers are proved, before {len(then)}")
    for name, (low, high) in now.items():
        slack = BOUND_SLACK * max(map(abs, (low, high, *then[name])))
        if not (low <= then[name][1] + slack and then[name][0] <= high + slack):
            before = "[{:.6g}, {:.6g}]".format(*then[name])
            return Agreement("differs", f"{name} in [{low:.6g}, {high:.6g}], before in {before}")
    return Agreement("within certificates", f"{len(now)} proved number{'s' * (len(now) > 1)}")


def _of_numbers(before: Any, again: Any) -> Agreement:
    """Compare arrays and metrics of results that prove nothing, each by its largest entry."""
    then, now = dict(_numbers(before)), dict(_numbers(again))
    if {name: array.shape for name, array in then.items()} != {name: array.shape for name, array in now.items()}:
        return Agreement("differs", "other arrays or metrics")
    worst, largest = "", 0.0
    for name, array in now.items():
        if not (np.isnan(array) == np.isnan(then[name])).all():
            return Agreement("differs", f"{name} is undefined elsewhere")
        change = np.abs(np.nan_to_num(array) - np.nan_to_num(then[name])).max(initial=0.0)
        share = float(change / (np.abs(np.nan_to_num(then[name])).max(initial=0.0) or 1.0))
        worst, largest = (name, share) if share > largest else (worst, largest)
    reason = f"{worst or 'text'} by {largest:.1e} of its largest, nothing is proved about it"
    return Agreement("within rounding" if largest <= ROUNDING else "differs", reason)


def _numbers(result: Any) -> Iterator[tuple[str, np.ndarray]]:
    from surfexp.commands.exporting.writers import arrays_of

    yield from ((name, np.asarray(array, dtype=np.float64)) for name, array in arrays_of(result).items())
    yield from ((name, np.asarray(value, np.float64)) for name, value in getattr(result, "metrics", {}).items())
