"""Which modes of two people correspond: what order and correlation say, what is proved, and what is true of twins."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import combinations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.member import Member
from surfexp.embedding.mode_pairs import ModePairs
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic

from .paired_modes import METHODS, PairedModes, pair_modes, true_pairs

BANDS = {"1 to 10": (0, 10), "11 to 25": (10, 25), "26 to 50": (25, 50)}


def modes_of_people(
    surfaces: Mapping[Member, Surface],
    systems: Mapping[Member, EigenSystem],
    count: int = 50,
    report: Callable[[int, float], None] | None = None,
) -> Statistic:
    """Pair the modes of all pairs of people, of whom nobody knows the truth.

    Parameters
    ----------
    surfaces, systems : mapping of Member to Surface and EigenSystem
        The same structure of each person.
    count : int
    report : callable, optional
        Called with the pairs that are done, and the share that is left.

    Returns
    -------
    Statistic
        Columns, a row a mode, shares of pairs: mode; `single`; "itself, another, none by map" where the functional map
        names the mode of the same number, of another one, or none; the same "by space", by the map in space. Metrics:
        their means over modes; agreement of methods with the signs that were searched, over the leading modes.

    Raises
    ------
    ValueError
        If there are fewer than two people; as `pair_modes`.
    """
    if len(surfaces) < 2:
        raise ValueError(f"{len(surfaces)} subjects, at least 2 are needed")
    found: list[PairedModes] = []
    pairs = list(combinations(surfaces, 2))
    for one, other in pairs:
        found.append(pair_modes((surfaces[one], systems[one]), (surfaces[other], systems[other]), count))
        if report is not None:
            report(len(found), 1.0 - len(found) / len(pairs))
    columns: dict[str, Floats] = {"mode": np.arange(1, count + 1, dtype=np.float64)}
    columns["single"] = np.asarray(np.mean([pair.single for pair in found], axis=0), np.float64)
    maps, spaces = [pair.methods["functional map"] for pair in found], [pair.space for pair in found]
    for name, each in (("map", maps), ("space", spaces)):
        columns |= {f"{what} by {name}": share for what, share in _fates(each).items()}
    metrics = {"pairs": float(len(found)), "modes in blocks of one": float(count * columns["single"].mean())}
    for name, (start, stop) in _bands(count).items():
        metrics |= {
            f"{what}, modes {name}": float(shares[start:stop].mean())
            for what, shares in columns.items()
            if " by " in what
        }
    metrics |= _sign_metrics(found)
    both = np.array([one.paired & other.paired for one, other in zip(maps, spaces, strict=True)])
    same = np.array([one.agrees(other) for one, other in zip(maps, spaces, strict=True)]) & both
    metrics["map and space agree"] = float(same.sum() / max(int(both.sum()), 1))
    return Statistic("modes across people", columns, metrics=metrics)


def _fates(pairs: list[ModePairs]) -> dict[str, Floats]:
    """Shares of pairs, by mode: it is itself, another one, or none."""
    partners = np.array([each.partners for each in pairs])
    itself, none = partners == np.arange(partners.shape[1]), partners < 0
    fates = {"itself": itself, "another": ~itself & ~none, "none": none}
    return {name: np.asarray(one.mean(axis=0), np.float64) for name, one in fates.items()}


def _bands(count: int) -> dict[str, tuple[int, int]]:
    return {name: (start, stop) for name, (start, stop) in BANDS.items() if stop <= count}


def _sign_metrics(found: list[PairedModes]) -> dict[str, float]:
    """How many modes have their signs searched, how often with proof, and which methods name the same."""
    leading = np.array([pair.leading for pair in found], dtype=np.float64)
    metrics = {"leading modes": float(leading.mean()), "signs proved": _proved(found)}
    for method in METHODS:
        same = sum(int((pair.signs.agrees(pair.methods[method]) & pair.signs.paired).sum()) for pair in found)
        metrics[f"{method} agrees"] = float(same / max(leading.sum(), 1.0))
    return metrics


def _proved(found: list[PairedModes]) -> float:
    """Share of proofs among pairs with a sign to search; 1 where there is no such pair."""
    searched = [pair.proved for pair in found if pair.leading]
    return float(np.mean(searched)) if searched else 1.0


def pooled(statistics: Mapping[Member, Statistic]) -> Statistic:
    """Mean over structures of the shares of `modes_of_people`, with the least and the largest of a structure.

    Raises
    ------
    ValueError
        If structures have other numbers of pairs or modes.
    """
    found = list(statistics.values())
    sizes = {(one.metrics["pairs"], len(one.columns["mode"])) for one in found}
    if len(sizes) != 1:
        raise ValueError(f"structures have pairs and modes {sorted(sizes)}, equal numbers are needed")
    columns = {"mode": found[0].columns["mode"]}
    for name in found[0].columns:
        if name != "mode":
            table = np.array([one.columns[name] for one in found])
            columns[name] = np.stack([table.mean(axis=0), table.min(axis=0), table.max(axis=0)], axis=1)
    metrics = {name: float(np.mean([one.metrics[name] for one in found])) for name in found[0].metrics}
    metrics["pairs"] *= len(found)
    return Statistic("modes across people, all structures", columns, metrics=metrics)


def modes_of_twins(
    original: tuple[Surface, EigenSystem],
    twins: Mapping[Member, tuple[Surface, EigenSystem]],
    count: int = 50,
    report: Callable[[int, float], None] | None = None,
) -> Statistic:
    """Pair the modes of a surface with those of deformed and disguised copies, whose true counterparts are known.

    Parameters
    ----------
    original : tuple of Surface and EigenSystem
    twins : mapping of Member to (Surface, EigenSystem)
        With the vertices of the original in `truth.origin`; the level of a member is its deformation.
    count : int
    report : callable, optional
        As in `modes_of_people`.

    Returns
    -------
    Statistic
        Columns, a row a level: level, pairs, `itself`, `another`, `none` as in `modes_of_people` but true, and the share
        of true counterparts that a method finds with their sign, "METHOD right". Metrics: the same, ", level LEVEL".

    Raises
    ------
    ValueError
        If a twin does not know its origin or has no level; as `pair_modes`.
    """
    levels: dict[float, list[tuple[PairedModes, ModePairs]]] = {}
    for number, (member, twin) in enumerate(twins.items(), start=1):
        if member.level is None or twin[0].truth.origin is None or twin[0].truth.template != original[0].mesh.identity:
            raise ValueError(f"twin {member.label!r} has no level, or does not know its vertices on the original")
        true = true_pairs(original, twin, twin[0].truth.origin, count)
        levels.setdefault(member.level, []).append((pair_modes(original, twin, count), true))
        if report is not None:
            report(number, 1.0 - number / len(twins))
    rows = {level: _rated(levels[level], count) for level in sorted(levels)}
    columns = {"level": np.array(list(rows))}
    columns |= {name: np.array([row[name] for row in rows.values()]) for name in next(iter(rows.values()))}
    metrics = {f"{name}, level {level:g}": value for level, row in rows.items() for name, value in row.items()}
    return Statistic("modes of twins", columns, metrics=metrics)


def _rated(found: list[tuple[PairedModes, ModePairs]], count: int) -> dict[str, float]:
    order = np.arange(count)
    paired = np.array([true.paired for _, true in found])
    itself = np.array([true.partners == order for _, true in found])
    rated = {"pairs": float(len(found)), "itself": float(itself.mean()), "none": float(1.0 - paired.mean())}
    rated["another"] = float((paired & ~itself).mean())
    for name, (start, stop) in _bands(count).items():
        rated[f"itself, modes {name}"] = float(itself[:, start:stop].mean())
    for method in METHODS:
        right = np.array([pair.methods[method].agrees(true) for pair, true in found]) & paired
        rated[f"{method} right"] = float(right.sum() / max(paired.sum(), 1))
    # a method that names counterparts may also name some where there are none
    named = np.array([pair.methods["functional map"].paired for pair, _ in found])
    rated["functional map invents"] = float((named & ~paired).sum() / max(named.sum(), 1))
    leading = sum(pair.leading for pair, _ in found)
    known = sum(int((pair.signs.agrees(true) & pair.signs.paired).sum()) for pair, true in found)
    rated["signs proved"] = _proved([pair for pair, _ in found])
    return rated | {"leading modes": leading / len(found), "proved signs right": known / max(leading, 1)}
