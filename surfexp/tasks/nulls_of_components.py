"""Null maps drawn for each component of a surface by itself: what is random in one has no share in another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart, surface_part
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.nulls.eigenstrapping import eigenstrapped, group_powers
from surfexp.nulls.kept import power_error, rest_correlation, variogram_error
from surfexp.nulls.neighbourhoods import nearest_along_surface
from surfexp.nulls.variogram import variogram_pairs
from surfexp.nulls.variogram_matching import VariogramMatching
from surfexp.operators.assembly import mass_matrix
from surfexp.spectrum.lowest_pairs import lowest_pairs
from surfexp.spectrum.single_slice import Progress

NEIGHBOURS = 1000
# narrow enough for maps that change within ten vertices; see docs/null_models.md
FRACTIONS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8)
REACH = 0.25
TOLERANCE = 1e-10
# share of the variance that neighbours have in common in what modes leave out, from which on null maps are too rough
MOST_LOST = 0.05
# of modes among the vertices of a component: higher ones change from vertex to vertex
MOST_MODES = 0.5
# the constant one and one that is turned
FEWEST_MODES = 2

Said = TypeVar("Said")
Seed = int | Sequence[int]
Drawn = tuple[Floats, dict[str, Any], tuple[str, ...]]


class TooFewVerticesError(ValueError):
    """A surface on which variograms cannot be matched."""


class _Turned(NamedTuple):
    """What the modes of a component hold of its map, and what their null maps keep."""

    modes: int
    held: float
    variance: float
    power_error: float
    rest_correlation: float
    complete: bool
    notes: tuple[str, ...]


def by_modes(
    owner: Surface,
    mesh: TriangleMesh,
    inside: Floats,
    count: int,
    modes: int,
    seed: int,
    threads: int = 1,
    progress: Progress | None = None,
) -> Drawn:
    """Return null maps by eigenstrapping, what is certified of them, and notes.

    Parameters
    ----------
    owner : Surface
        Whose name and unit messages have.
    mesh : TriangleMesh
    inside : (n,) float64
    count, modes, seed, threads : int
    progress : callable, optional
        As of `eigenpairs`, for each component.

    Raises
    ------
    ValueError
        If the map is constant on each component, or a component has too few vertices.
    """

    def turned(one: SurfacePart, values: Floats, seed: Seed) -> tuple[Floats, _Turned]:
        many = min(modes, int(MOST_MODES * len(values)))
        if many < FEWEST_MODES:
            raise ValueError(
                f"the map is on {len(values)} vertices, at least {round(FEWEST_MODES / MOST_MODES)} are needed"
            )
        cut = Surface(one.mesh, owner.name, owner.unit)
        operator, system = lowest_pairs(cut, many, tolerance=TOLERANCE, progress=progress, threads=threads)
        mass = mass_matrix(operator)
        nulls = eigenstrapped(system.vectors, mass, values, count, rest="permute", seed=seed)
        centred = values - operator.mass @ values / operator.mass.sum()
        return nulls, _Turned(
            many,
            float(group_powers(system.vectors, mass, values[:, None])[1:].sum()),
            float(centred @ (mass @ centred)),
            float(np.median(power_error(system.vectors, mass, values, nulls))),
            rest_correlation(system.vectors, mass, values, one.mesh.edges),
            system.complete,
            operator.notes,
        )

    nulls, said, notes = _of_each_component(mesh, inside, count, seed, turned)
    share = sum(one.held for one in said) / sum(one.variance for one in said)
    fewest, lost = min(one.modes for one in said), max(one.rest_correlation for one in said)
    certificate = {
        "share_in_modes": share,
        "power_error": max(one.power_error for one in said),
        "rest_correlation": lost,
        "modes": fewest,
        "complete": all(one.complete for one in said),
    }
    notes += tuple(note for one in said for note in one.notes)
    if fewest < modes:
        notes += (f"{fewest} modes were turned, and not {modes}: a mesh of few vertices has no more that are smooth.",)
    if lost > MOST_LOST:
        notes += (
            f"{fewest} modes leave out {1.0 - share:.0%} of the map's variance, in which neighbours correlate "
            f"({lost:.2f} of the variance): permuted, it makes null maps too rough, and tests reject too often. Take more "
            "modes, or method='variogram'.",
        )
    return nulls, certificate, notes


def by_variogram(mesh: TriangleMesh, inside: Floats, count: int, seed: int) -> Drawn:
    """Return null maps whose variograms are that of the map, as `by_modes` does.

    Raises
    ------
    TooFewVerticesError
        If variograms of a component cannot be matched.
    ValueError
        If the map is constant on each component.
    """

    def matched(one: SurfacePart, values: Floats, seed: Seed) -> tuple[Floats, float]:
        try:
            pairs = variogram_pairs(one.mesh, reach=REACH * float(np.sqrt(one.mesh.area)))
            nearest = nearest_along_surface(one.mesh, min(NEIGHBOURS, len(values)))
            kernels = VariogramMatching(*nearest, pairs, FRACTIONS)
        except ValueError as error:
            component = "" if mesh.component_count == 1 else " of a component"
            raise TooFewVerticesError(
                f"{len(values)} vertices{component} are too few for variograms, take method='eigenstrapping' ({error})"
            ) from None
        # what makes random numbers takes one or several
        nulls = kernels.nulls(values, count, seed=cast(int, seed))
        return nulls, float(np.median(variogram_error(pairs, values, nulls)))

    nulls, errors, notes = _of_each_component(mesh, inside, count, seed, matched)
    return nulls, {"variogram_error": max(errors)}, notes


def _of_each_component(
    mesh: TriangleMesh,
    inside: Floats,
    count: int,
    seed: int,
    drawn: Callable[[SurfacePart, Floats, Seed], tuple[Floats, Said]],
) -> tuple[Floats, list[Said], tuple[str, ...]]:
    """Null maps of all components, and what is said of each; where the map is constant they are."""
    nulls, said, notes = np.empty((len(inside), count)), [], []
    for component in range(mesh.component_count):
        one = surface_part(mesh, mesh.component_labels == component)
        values = inside[one.vertices]
        if values.min() == values.max():
            nulls[one.vertices] = values[0]
            notes.append(
                f"The map is constant on a component of {len(values)} vertices, and so are its null maps there."
            )
            continue
        nulls[one.vertices], found = drawn(one, values, seed if component == 0 else [seed, component])
        said.append(found)
    if not said:
        raise ValueError("the map is constant on each component: null models need one that varies")
    return nulls, said, tuple(notes)
