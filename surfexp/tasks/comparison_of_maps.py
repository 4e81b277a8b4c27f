"""The correlation of two maps, against null maps of the first."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.given_numbers import one_of
from surfexp.mesh.surface_part import finite_mask
from surfexp.nulls.rejection import correlations, effective_interval, p_values
from surfexp.spectrum.single_slice import Progress
from surfexp.tasks.given_map import MapLike, as_single_map
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.null_maps import NullMaps, null_maps
from surfexp.tasks.nulls_of_components import MOST_LOST, TooFewVerticesError
from surfexp.tasks.part_of_task import part_for
from surfexp.variational.own_unit import own_unit


@dataclass(frozen=True, eq=False, repr=False)
class MapComparison(Drawable):
    """The correlation of two maps, by area, and what null maps say of it.

    Parameters
    ----------
    r : float
        Correlation of the two maps.
    p : float
        Two-sided: (1 + null correlations that reach r in modulus) / (1 + their number).
    interval : (float, float)
        95 % confidence interval of the correlation: Fisher's, for as many independent observations as give null
        correlations of the variance that they have.
    observations : float
        That number, 1 + 1 / variance.
    null : (c,) float64
        Correlations of the null maps with the second map.
    surrogates : NullMaps
        Null maps of the first map.
    reason : str
        Why this null model.
    notes : tuple of str
    """

    r: float
    p: float
    interval: tuple[float, float]
    observations: float
    null: Floats
    surrogates: NullMaps
    reason: str
    notes: tuple[str, ...] = ()

    @property
    def method(self) -> str:
        """The null model."""
        return self.surrogates.method

    @property
    def facts(self) -> dict[str, Any]:
        """All numbers by name."""
        low, high = self.interval
        numbers = {"r": self.r, "p": self.p, "low": low, "high": high, "observations": self.observations}
        return numbers | {"null maps": len(self.null), "method": self.method} | self.surrogates.certificate

    def _summary(self) -> Summary:
        low, high = self.interval
        facts: dict[str, Any] = {"r": self.r, "p": self.p, "95 % interval": f"{low:.3f} to {high:.3f}"}
        facts |= {"null maps": len(self.null), "method": self.method}
        return Summary("correlation of two maps", facts, (self.reason, *self.notes))


def compare_maps(
    surface: SurfaceLike,
    first: MapLike,
    second: MapLike,
    *,
    method: Literal["auto", "eigenstrapping", "variogram"] = "auto",
    count: int = 1000,
    modes: int = 400,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> MapComparison:
    """Correlate two maps of a surface, and tell the correlation from chance by null maps.

    Vertices of smooth maps are not independent, so that Student's test rejects up to 87 % of unrelated pairs. Null maps are
    as smooth as the first map and otherwise random. The correlation is weighted by the areas of the vertices.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        Maps are compared inside the mask, or where both are finite if there is no mask.
    first, second : str or (n,) float64
        Names of maps of the surface, or maps; NaN where nothing is known. Null maps are made of the first.
    method : {"auto", "eigenstrapping", "variogram"}
        "auto" rotates the coefficients of modes where permuting what the modes leave out loses no more than .05 of the
        map's variance in correlation between neighbours, and matches variograms elsewhere.
    count : int
        Number of null maps.
    modes : int
        Of "eigenstrapping".
    seed : int
    threads, progress : optional
        As in `null_maps`.

    Returns
    -------
    MapComparison

    Raises
    ------
    ValueError
        If a map does not fit or is constant, or a number is out of range.

    References
    ----------
    Alexander-Bloch et al.: On testing for spatial correspondence between maps of human brain structure and function (2018).
    Clifford, Richardson, Hemon: Assessing the significance of the correlation between two spatial processes (1989).

    Examples
    --------
    >>> import surfexp as sx
    >>> ball = sx.shape("icosphere", levels=3)
    >>> x, y, z = ball.mesh.vertices.T
    >>> found = sx.compare_maps(ball, z, z + x, count=199, modes=36)
    >>> round(found.r, 2), found.method, found.p > 0.05
    (0.71, 'eigenstrapping', True)
    """
    one_of(method, "method", ("auto", "eigenstrapping", "variogram"))
    owner = as_surface(surface)
    rough, other = as_single_map(owner, first), as_single_map(owner, second)
    known = finite_mask((rough, other), len(rough))
    part = part_for(owner, rough, other)
    inside = owner if known is None else replace(owner, mask=known if owner.mask is None else known & owner.mask)
    within = other[part.vertices]
    if within.min() == within.max():
        raise ValueError(f"the second map is constant at {within[0]:g}: a correlation needs one that varies")
    surrogates, reason = chosen_null_maps(
        inside, rough, method=method, count=count, modes=modes, seed=seed, threads=threads, progress=progress
    )
    held = np.asarray(np.isfinite(surrogates.values).all(axis=1))
    weights = (part.mesh.vertex_areas / part.mesh.area)[held[part.vertices]]
    own, others = own_unit(rough[held]), own_unit(other[held])
    partner = others.normalised(other[held, None])
    null = correlations(own.normalised(surrogates.values[held]), partner, weights)
    r = correlations(own.normalised(rough[held, None]), partner, weights)[0]
    low, high, observations = effective_interval(float(r[0]), null[:, 0])
    notes = tuple(dict.fromkeys((*part.notes, *surrogates.notes)))
    return MapComparison(
        float(r[0]), float(p_values(r, null)[0]), (low, high), observations, null[:, 0], surrogates, reason, notes
    )


def chosen_null_maps(
    surface: SurfaceLike,
    values: MapLike,
    *,
    method: Literal["auto", "eigenstrapping", "variogram"] = "auto",
    count: int = 1000,
    modes: int = 400,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> tuple[NullMaps, str]:
    """Return null maps by a model, or by the one that a map calls for, and why.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
    values : str or (n,) float64
    method, count, modes, seed, threads, progress
        As `compare_maps`.

    Returns
    -------
    NullMaps
    str
    """
    if method == "variogram":
        return null_maps(surface, values, count, method="variogram", seed=seed), "Variograms were asked for."
    made = null_maps(surface, values, count, modes=modes, seed=seed, threads=threads, progress=progress)
    lost, share = made.certificate["rest_correlation"], made.certificate["share_in_modes"]
    said = (
        f"{made.certificate['modes']} modes hold {share:.0%} of the map's variance, and permuting the rest loses {lost:.2f} "
        "of it in correlation of neighbours"
    )
    if method == "eigenstrapping" or lost <= MOST_LOST:
        return made, f"Eigenstrapping{' was asked for' if method == 'eigenstrapping' else ''}: {said}."
    try:
        return null_maps(
            surface, values, count, method="variogram", seed=seed
        ), f"Variograms: {said}, over {MOST_LOST:g}."
    except TooFewVerticesError as error:
        # made.notes say that these are too rough
        few = str(error).partition(",")[0]
        return made, f"Eigenstrapping: {said}, over {MOST_LOST:g}, but {few}."
