"""Null models of a map: random maps as smooth as it is, to tell a correlation from chance."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.given_numbers import given_threads, one_of, whole_number
from surfexp.mesh.surface_part import SurfacePart, surface_part
from surfexp.spectrum.single_slice import Progress
from surfexp.tasks.given_map import MapLike, as_single_map
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.nulls_of_components import FEWEST_MODES, by_modes, by_variogram
from surfexp.tasks.part_of_task import part_for
from surfexp.variational.own_unit import own_unit

# numbers that a result may hold: 8 GB
LARGEST_RESULT = 10**9
LARGEST_SEED = 2**128 - 1
# a component with a smaller share of the vertices of the largest is an island
ISLAND = 0.05

APART = "Null maps of the two hemispheres are drawn apart: what their maps have in common is not kept."


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
    threads: int | None = None,
    progress: Progress | None = None,
) -> NullMaps:
    """Make surrogate maps with the same spatial autocorrelation as a map, to test its correlation with another map.

    "eigenstrapping" rotates the coefficients of the map at random, within groups of 3, 5, 7, ... modes of its surface. It
    adds the residual that the modes do not hold, with permuted values. "variogram" smooths permuted values until their
    variogram is that of the map. Both assume that the map is equally smooth everywhere. Each hemisphere, or other component,
    is drawn apart, with modes or a variogram of its own. "variogram" keeps its mean over the vertices; "eigenstrapping" its mean
    by area, but for the permuted residual.

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
    threads : int, optional
        For modes, as in `eigenpairs`.
    progress : callable, optional
        Receives the number of modes found and the share that is missing.

    Returns
    -------
    NullMaps
        `values`, and the certificate: share_in_modes (of the map's variance), power_error (of groups, 0 where
        the modes hold all; the largest of components), rest_correlation (of neighbours, that permuting the residual
        loses, over the map's variance) and complete, or variogram_error (the largest of components); errors are relative, medians
        over null maps.
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
    one_of(method, "method", ("eigenstrapping", "variogram"))
    threads = given_threads(threads)
    owner = as_surface(surface)
    count = whole_number(count, "count", 1, LARGEST_RESULT // len(owner.mesh.vertices))
    rough = as_single_map(owner, values)
    part, islands = _without_islands(part_for(owner, rough))
    inside = np.asarray(part.restrict(rough), dtype=np.float64)
    if inside.min() == inside.max():
        raise ValueError(f"the map is constant at {inside[0]:g}: null models need one that varies")
    own = own_unit(inside)
    scaled = own.normalised(inside)
    made, certificate, notes = (
        by_variogram(part.mesh, scaled, count, seed)
        if method == "variogram"
        else by_modes(owner, part.mesh, scaled, count, modes, seed, threads, progress)
    )
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
