"""Signs of modes of people where a map of the surfaces and a map in space agree on the counterpart."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from surfexp.contract.member import Member
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic

from .paired_modes import PairedModes, pair_modes

RULES = ("proved", "order, skewness", "order, largest value")


def agreed_signs(
    surfaces: Mapping[Member, Surface], systems: Mapping[Member, EigenSystem], count: int = 50
) -> Statistic:
    """Rate signs of modes where the functional map and the map in space agree on them, for all pairs of people.

    Nobody knows the truth of people; where two maps agree that look at different things, they are taken for it.

    Parameters
    ----------
    surfaces, systems : mapping of Member to Surface and EigenSystem
    count : int

    Returns
    -------
    Statistic
        Rows: a pair of people each. Columns: agreed modes among the leading ones, and how many of these have the sign of
        each rule. Metrics: `agreed`, modes a pair, and shares "RULE right" over all pairs.

    Raises
    ------
    ValueError
        If there are fewer than two people; as `pair_modes`.
    """
    if len(surfaces) < 2:
        raise ValueError(f"{len(surfaces)} subjects, at least 2 are needed")
    rows, names = [], []
    for one, other in combinations(surfaces, 2):
        rows.append(_counts(pair_modes((surfaces[one], systems[one]), (surfaces[other], systems[other]), count)))
        names.append(f"{one}, {other}")
    table = np.array(rows, dtype=np.float64)
    columns = dict(zip(("agreed", *RULES), table.T, strict=True))
    total = max(float(table[:, 0].sum()), 1.0)
    metrics = {"agreed": float(table[:, 0].mean())}
    metrics |= {f"{rule} right": float(columns[rule].sum() / total) for rule in RULES}
    return Statistic("signs where maps agree", columns, tuple(names), metrics)


def _counts(pair: PairedModes) -> list[int]:
    """Leading modes on which both maps agree, and of these those with the sign of each rule."""
    by_map = pair.methods["functional map"]
    agreed = by_map.agrees(pair.space) & (by_map.partners == np.arange(len(by_map.partners))) & pair.signs.paired
    found = {"proved": pair.signs} | pair.methods
    return [int(agreed.sum()), *(int((agreed & found[rule].agrees(by_map)).sum()) for rule in RULES)]
