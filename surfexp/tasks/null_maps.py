"""Null models of a map: random maps as smooth as it is, to tell a correlation from chance."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.given_numbers import one_of, whole_number
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
from surfexp.tasks.given_map import MapLike, as_single_map
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for
from surfexp.variational.own_unit import own_unit

NEIGHBOURS = 1000
# numbers that a result may hold: 8 GB
LARGEST_RESULT = 10**9
LARGEST_SEED = 2**128 - 1
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
# a component with a smaller share of the vertices of the largest is an island
ISLAND = 0.05

APART = "Null maps of the two hemispheres are drawn apart: what their maps have in common is not kept."


class TooFewVerticesError(ValueError):
    """A surface on which variograms cannot be matched."""


@dataclass(frozen=True, eq=False, repr=False)
class NullMaps(Drawable):
    """Surrogate maps, which keep some properties of a map and are random otherwise.

    Parameters
    ----------
    values : (n, r) float64
        One column for each null map; NaN outside the mask.
    method : str
        "eigenstrapping" or "variogram".
    certificate : dict
        What is kept, and how well.
    notes : tuple of str
    """

    values: Floats
    method: str
    certificate: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def _summary(self) -> Summary:
        facts = {"null maps": self.values.shape[1]}
        return Summary(f"null maps by {self.method}", facts | self.certificate, self.notes)


def null_maps(
    surface: SurfaceLike,
    values: MapLike,
    count: int = 1000,
    *,
    method: Literal["eigenstrapping", "variogram"] = "eigenstrapping",
    modes: int = 400,
    seed: int = 0,
) -> NullMaps:
    """Make surrogate maps with the same spatial autocorrelation as a map, to test its correlation with another map.

    "eigenstrapping" rotates the coefficients of the map at random, within groups of 3, 5, 7, ... modes of its surface. It
    adds the residual that the modes do not hold, with permuted values. Each hemisphere, or other
    component, has modes of its own. "variogram" smooths permuted values until their
    variogram is that of the map. Both assume that the map is equally smooth everywhere.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        Null maps are made inside the mask, or where the map is finite if there is no mask.
    values : str or (n,) float64
        Name of a map of the surface, or the map; NaN where nothing is known.
    count : int
        Number of null maps, r.
    method : {"eigenstrapping", "variogram"}
    modes : int
        Of "eigenstrapping", at most half as many as a component has vertices; they are proved complete.
    seed : int

    Returns
    -------
    NullMaps
        `values`, and the certificate: share_in_modes (of the map's variance), power_error (of groups, 0 where
        the modes hold all; the largest of components), rest_correlation (of neighbours, that permuting the residual
        loses, over the map's variance) and complete, or variogram_error; errors are relative, medians over null maps.
        Notes say where that loss is over .05. They name islands, components with less than a twentieth of the vertices
        of the largest, which are NaN.

    Raises
    ------
    ValueError
        If the map does not fit, is constant or has several channels, or a number is out of range.

    References
    ----------
    Koussis et al.: Generation of surrogate brain maps preserving spatial autocorrelation through random rotation of
    geometric eigenmodes (2025). Burt et al.: Generative modeling of brain maps with spatial autocorrelation (2020).

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> nulls = sx.null_maps(sphere, sphere.mesh.vertices[:, 2], 99, modes=36)
    >>> nulls.values.shape, bool(nulls.certificate["share_in_modes"] > 0.999)
    ((642, 99), True)
    """
    count, modes = whole_number(count, "count", 1), whole_number(modes, "modes", FEWEST_MODES)
    seed = whole_number(seed, "seed", 0, LARGEST_SEED)
    makers = {"eigenstrapping": _by_modes, "variogram": _by_variogram}
    chosen = makers[one_of(method, "method", makers)]
    owner = as_surface(surface)
    count = whole_number(count, "count", 1, LARGEST_RESULT // len(owner.mesh.vertices))
    rough = as_single_map(owner, values)
    part, islands = _without_islands(part_for(owner, rough))
    inside = np.asarray(part.restrict(rough), dtype=np.float64)
    if inside.min() == inside.max():
        raise ValueError(f"the map is constant at {inside[0]:g}: null models need one that varies")
    own = own_unit(inside)
    made, certificate, notes = chosen(owner, part.mesh, own.normalised(inside), count, modes, seed)
    notes += (APART,) if owner.right is not None else ()
    return NullMaps(part.extend(own.restored(made)), method, certificate, part.notes + islands + notes)


def _without_islands(part: SurfacePart) -> tuple[SurfacePart, tuple[str, ...]]:
    """Leave out components that are much smaller than the largest, and name them."""
    sizes = np.bincount(part.mesh.component_labels)
    small = np.flatnonzero(sizes < ISLAND * sizes.max())
    if not len(small):
        return part, ()
    labels = part.mesh.component_labels
    shown = [f"{sizes[k]} at vertex {part.vertices[np.flatnonzero(labels == k)[0]]}" for k in small[:3]]
    more = f" and {len(small) - 3} more" if len(small) > 3 else ""
    note = (
        f"{len(small)} islands of few vertices ({', '.join(shown)}{more}) carry no null map: they are NaN, as outside of a "
        "mask."
    )
    kept = surface_part(part.mesh, ~np.isin(labels, small))
    return replace(part, mesh=kept.mesh, vertices=part.vertices[kept.vertices]), (note,)


def _by_modes(
    owner: Surface, mesh: TriangleMesh, inside: Floats, count: int, modes: int, seed: int
) -> tuple[Floats, dict[str, Any], tuple[str, ...]]:
    """Each component by modes of its own: what is turned in one has no share in another."""
    nulls = np.empty((len(inside), count))
    held, variance, kept, lost, complete, fewest = 0.0, 0.0, 0.0, -np.inf, True, modes
    notes: tuple[str, ...] = ()
    for component in range(mesh.component_count):
        one = surface_part(mesh, mesh.component_labels == component)
        values = inside[one.vertices]
        if values.min() == values.max():
            nulls[one.vertices] = values[0]
            notes += (f"The map is constant on a component of {len(values)} vertices, and so are its null maps there.",)
            continue
        turned = min(modes, int(MOST_MODES * len(values)))
        if turned < FEWEST_MODES:
            raise ValueError(
                f"the map is on {len(values)} vertices, at least {round(FEWEST_MODES / MOST_MODES)} are needed"
            )
        fewest = min(fewest, turned)
        operator, system = lowest_pairs(Surface(one.mesh, owner.name, owner.unit), turned, tolerance=TOLERANCE)
        notes += operator.notes
        mass = mass_matrix(operator)
        own_seed = seed if component == 0 else [seed, component]
        found = eigenstrapped(system.vectors, mass, values, count, rest="permute", seed=own_seed)
        nulls[one.vertices] = found
        centred = values - operator.mass @ values / operator.mass.sum()
        held += float(group_powers(system.vectors, mass, values[:, None])[1:].sum())
        variance += float(centred @ (mass @ centred))
        kept = max(kept, float(np.median(power_error(system.vectors, mass, values, found))))
        lost = max(lost, rest_correlation(system.vectors, mass, values, one.mesh.edges))
        complete &= system.complete
    if variance == 0.0:
        raise ValueError("the map is constant on each component: null models need one that varies")
    certificate = {"share_in_modes": held / variance, "power_error": kept, "rest_correlation": lost}
    certificate |= {"modes": fewest, "complete": complete}
    if fewest < modes:
        notes += (f"{fewest} modes were turned, and not {modes}: a mesh of few vertices has no more that are smooth.",)
    if lost > MOST_LOST:
        notes += (
            f"{fewest} modes leave out {1.0 - held / variance:.0%} of the map's variance, in which neighbours correlate "
            f"({lost:.2f} of the variance): permuted, it makes null maps too rough, and tests reject too often. Take more "
            "modes, or method='variogram'.",
        )
    return nulls, certificate, notes


def _by_variogram(
    owner: Surface, mesh: TriangleMesh, inside: Floats, count: int, modes: int, seed: int
) -> tuple[Floats, dict[str, Any], tuple[str, ...]]:
    smallest = int(np.bincount(mesh.component_labels).min())
    try:
        pairs = variogram_pairs(mesh, reach=REACH * float(np.sqrt(mesh.area)))
        kernels = VariogramMatching(*nearest_along_surface(mesh, min(NEIGHBOURS, smallest)), pairs, FRACTIONS)
    except ValueError as error:
        raise TooFewVerticesError(
            f"{len(inside)} vertices are too few for variograms, take method='eigenstrapping' ({error})"
        ) from None
    nulls = kernels.nulls(inside, count, seed=seed)
    return nulls, {"variogram_error": float(np.median(variogram_error(pairs, inside, nulls)))}, ()
