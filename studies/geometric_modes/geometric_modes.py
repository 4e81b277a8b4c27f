"""What the modes of a surface add: maps rebuilt from its own modes and from those of other geometries on its vertices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats
from surfexp.contract.member import Member
from surfexp.mesh.surface import Surface
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.reconstruction import accuracy_curves, area_over_log
from surfexp.statistics.resampling import BOOTSTRAPS, CENTRAL
from surfexp.statistics.statistic import Statistic

OWN = "own"
TWIN = "twin of {}"


def twin_maps(system: EigenSystem, count: int, seeds: Sequence[int]) -> Floats:
    """Return random maps whose power falls as 1 / eigenvalue over the modes 2 to `count`, and ends there.

    Parameters
    ----------
    system : EigenSystem
        Whose modes they are made of: all of them explain all of a map.
    count : int
    seeds : sequence of int
        A map each.

    Returns
    -------
    (n, seeds) float64

    Raises
    ------
    ValueError
        If there are fewer modes, or a second one is constant.
    """
    if not 2 <= count <= len(system.values) or system.values[1] <= 0:
        raise ValueError(f"count = {count} modes of {len(system.values)}, take 2 to all of a connected surface")
    drawn = np.column_stack([np.random.default_rng(seed).normal(size=count - 1) for seed in seeds])
    return np.asarray(system.vectors[:, 1:count] @ (drawn / np.sqrt(system.values[1:count, None])))


def mode_reconstruction(
    surface: Surface,
    operator: SurfaceOperator,
    own: EigenSystem,
    bases: Mapping[Member, EigenSystem],
    maps: Sequence[str],
    twins: Sequence[str] = (),
    seeds: int = 20,
    first: int = 10,
    last: int = 400,
) -> Statistic:
    """Rebuild maps from the first k modes of several geometries, k from `first` to `last`.

    Every basis is projected on in the inner product of the surface's own mass, in which it is not orthonormal unless it
    is the own one.

    Parameters
    ----------
    surface : Surface
        With the maps.
    operator : SurfaceOperator
    own : EigenSystem
    bases : mapping of Member to EigenSystem
        Of other geometries with the same vertices; those of one class are averaged.
    maps : sequence of str
    twins : sequence of str
        "own" or a class of the bases: random maps made of its modes are rebuilt as well, see `twin_maps`.
    seeds : int
        Random maps of each twin, numbered from 0.
    first, last : int

    Returns
    -------
    Statistic
        Columns, a row a number of modes: modes, and the accuracy "MAP, BASIS" (mean, least and largest over twins and
        members of a class). Metrics: the area under a curve over log k, "area MAP, BASIS"; the accuracy at `last`,
        "end MAP, BASIS"; differences of areas, "BASIS less BASIS, MAP" with the least and the largest of them.

    Raises
    ------
    ValueError
        If a map, a twin or modes are missing, or a basis has other vertices.
    """
    kinds = {OWN: [own]}
    for member, system in bases.items():
        kinds.setdefault(member.class_name, []).append(system)
    _check(surface, kinds, maps, twins, last)
    values = {name: np.asarray(surface.scalars[name], dtype=np.float64)[:, None] for name in maps}
    values |= {TWIN.format(kind): twin_maps(kinds[kind][0], last, range(seeds)) for kind in twins}
    curves = _curves(kinds, mass_matrix(operator), values, last)
    columns: dict[str, Floats] = {"modes": np.arange(first, last + 1, dtype=np.float64)}
    metrics: dict[str, float] = {}
    for name in values:
        areas = {kind: area_over_log(curve, first, last) for kind, curve in curves[name].items()}
        for kind, curve in curves[name].items():
            part = curve[first - 1 :]
            columns[f"{name}, {kind}"] = np.stack([part.mean(axis=1), part.min(axis=1), part.max(axis=1)], axis=1)
            metrics |= {
                f"area {name}, {kind}": float(areas[kind].mean()),
                f"end {name}, {kind}": float(part[-1].mean()),
            }
        for one, other in combinations(kinds, 2):
            # each twin against itself, each member of a class against each of the other
            pairs = areas[one].reshape(-1, 1, values[name].shape[1]) - areas[other].reshape(
                1, -1, values[name].shape[1]
            )
            label = f"{one} less {other}, {name}"
            metrics |= {label: float(pairs.mean()), f"{label}, least": float(pairs.min())}
            metrics[f"{label}, largest"] = float(pairs.max())
    return Statistic("maps rebuilt from modes", columns, metrics=metrics)


def _check(
    surface: Surface, kinds: Mapping[str, list[EigenSystem]], maps: Sequence[str], twins: Sequence[str], last: int
) -> None:
    if len(kinds[OWN]) != 1:
        raise ValueError(f"a basis has the class {OWN!r}, that of the surface's own modes: take another word")
    for name in maps:
        if name not in surface.scalars:
            raise ValueError(f"no map {name!r} on {surface.name}, choose of {', '.join(surface.scalars) or 'none'}")
    for kind in twins:
        if kind not in kinds:
            raise ValueError(f"no basis {kind!r} to make twins of, choose of {', '.join(kinds)}")
    for kind, systems in kinds.items():
        for system in systems:
            shape = system.vectors.shape
            if shape[0] != len(surface.mesh.vertices) or shape[1] < last or not system.complete:
                raise ValueError(
                    f"basis {kind!r} has {shape[1]} modes of {shape[0]} vertices, complete {system.complete}; "
                    f"{last} of {len(surface.mesh.vertices)} are needed, proved complete"
                )


def _curves(
    kinds: Mapping[str, list[EigenSystem]], mass: csr_array, values: Mapping[str, Floats], last: int
) -> dict[str, dict[str, Floats]]:
    """Accuracies (last, members times maps) by name of the map and kind of the basis."""
    widths = [columns.shape[1] for columns in values.values()]
    together = np.column_stack(list(values.values()))
    found: dict[str, dict[str, Floats]] = {name: {} for name in values}
    for kind, systems in kinds.items():
        curves = [accuracy_curves(system.vectors[:, :last], mass, together) for system in systems]
        for name, columns in zip(
            values, zip(*(np.split(c, np.cumsum(widths)[:-1], axis=1) for c in curves), strict=True), strict=True
        ):
            found[name][kind] = np.column_stack(columns)
    return found


def reconstruction_differences(
    statistics: Mapping[Member, Statistic], maps: Sequence[str], reference: str = OWN, seed: int = 0
) -> Statistic:
    """Areas of one basis less those of every other, paired by map, with intervals by bootstrap of maps.

    Parameters
    ----------
    statistics : mapping of Member to Statistic
        Of `mode_reconstruction`, such as those of two hemispheres: their mean is one value of a map.
    maps : sequence of str
        At least two.
    reference : str
    seed : int

    Returns
    -------
    Statistic
        Rows: the other bases. Columns: `difference` with the ends of its interval, then each map's own difference.

    Raises
    ------
    ValueError
        If there are fewer than two maps, or the statistics do not have them.
    """
    if len(maps) < 2:
        raise ValueError(f"{len(maps)} maps, at least 2 are needed to draw from")
    known = next(iter(statistics.values())).metrics
    start = f"{reference} less "
    others = [name[len(start) :].rpartition(",")[0] for name in known if name.startswith(start)]
    others = [other for other in dict.fromkeys(others) if "," not in other]
    try:
        table = np.array(
            [
                [[found.metrics[f"{start}{other}, {name}"] for found in statistics.values()] for name in maps]
                for other in others
            ]
        ).mean(axis=2)
    except KeyError as error:
        raise ValueError(f"a statistic has no metric {error}, take maps that all have: {', '.join(maps)}") from error
    draws = np.random.default_rng(seed).integers(len(maps), size=(BOOTSTRAPS, len(maps)))
    low, high = np.percentile(table[:, draws].mean(axis=2), CENTRAL, axis=1)
    mean = table.mean(axis=1)
    columns = {"difference": np.stack([mean, low, high], axis=1)}
    columns |= {name: table[:, k] for k, name in enumerate(maps)}
    metrics = {"maps": float(len(maps))}
    for k, other in enumerate(others):
        label = f"{reference} less {other}"
        metrics |= {label: float(mean[k]), f"{label}, low": float(low[k]), f"{label}, high": float(high[k])}
    return Statistic("differences of areas under accuracy curves", columns, tuple(others), metrics)
