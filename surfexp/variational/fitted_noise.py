"""The noise of a map as it was read: where it is how large, how far it is correlated, and in words."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.noise_statistics import NoiseStatistics

# shares of all values or pairs from which on something is said
SOME_OUTLIERS = 0.001
TIED = 0.05
# ratio of the levels that a tenth of the vertices exceed and that a tenth stay below: 1.3 to 2.1 for one level
VARYING = 2.3
# growth up to which a spread is that of the noise: a map that is rough itself grows more
ROUGH = 1.35
# growth of a map beside noise of a tenth of its deviation is up to 2.1
HIDDEN = 2.2
# bounds of the weights by precision; outliers have the least
LEAST_WEIGHT, LARGEST_WEIGHT = 0.1, 10.0
# outliers that a text names
MOST_SHOWN = 8
ONE_MAP = (
    "Smooth noise cannot be told from the map by one measurement for certain: give a second measurement, if there is one "
    "(`second`, --second)."
)


@dataclass(frozen=True, eq=False, repr=False)
class FittedNoise(Drawable):
    """The noise of a map.

    Parameters
    ----------
    level : float
        Standard deviation, root mean square over the vertices that are no outliers, in the unit of the map; 0 only for a
        map that is affine wherever it varies.
    levels : (n,) float64
        The same at each vertex; NaN outside the mask. One number where no difference is seen.
    spread : float
        Ratio of the local levels that a tenth of the vertices exceed and that a tenth stay below, also where it counts as
        chance: 1.3 to 2.1 for noise of one level.
    width : float
        Full width at half maximum of the kernel that makes such noise of white noise, in the unit of the surface; 0 for
        noise that is independent from vertex to vertex.
    growth : float
        How much more the map differs from the mean of its second ring of neighbours than from that of the first: 1 for
        white noise alone, 2 and more where noise is not seen beside the map.
    step : float
        Of a map that is rounded; 0 where it is not.
    tied : float
        Share of the pairs of triangles on which the map is affine to rounding.
    outliers : (k,) int64
        Vertices whose value is far from that of all their neighbours.
    measurements : int
        1, or 2 where a second measurement was given.
    """

    level: float
    levels: Floats
    spread: float
    width: float
    growth: float
    step: float
    tied: float
    outliers: Integers
    measurements: int = 1

    @property
    def kinds(self) -> tuple[str, ...]:
        """What is not white about it, of "outliers", "varying", "smooth", "rounded", "partly constant", "hidden".

        Empty for white noise of one level. "hidden" is noise that is not seen beside the map.
        """
        found = {
            "outliers": len(self.outliers) > SOME_OUTLIERS * np.isfinite(self.levels).sum(),
            "varying": varies(self.spread, self.growth, self.measurements > 1),
            "smooth": self.width > 0,
            "rounded": self.step > 0,
            "partly constant": self.step == 0 and self.tied >= TIED,
            "hidden": self.measurements == 1 and self.growth > HIDDEN,
        }
        return tuple(kind for kind, said in found.items() if said)

    @property
    def notes(self) -> tuple[str, ...]:
        """The same in sentences, where there is something to be said."""
        return tuple(self.sentences.values())

    @property
    def sentences(self) -> dict[str, str]:
        """The notes by kind."""
        known = self.levels[np.isfinite(self.levels)]
        low, high = np.quantile(known, [0.1, 0.9]) if len(known) else (0.0, 0.0)
        sentences = {
            "outliers": f"{len(self.outliers)} of {len(known)} values are outliers, far from those of all their neighbours: "
            "method auto replaces them, the others follow them.",
            "varying": f"The noise differs over the surface: a tenth of the vertices has less than {low:.3g}, a tenth more "
            f"than {high:.3g}.",
            "smooth": f"The noise is smooth, as white noise is after a kernel of full width {self.width:.3g}."
            + (f" {ONE_MAP}" if self.measurements == 1 else ""),
            "rounded": f"The map is rounded to steps of {self.step:.3g}: its noise counts as not less than that of rounding. "
            "Labels are no map to denoise.",
            "partly constant": f"The map is constant or affine on {100 * self.tied:.0f} % of the surface: the noise is that "
            "of the rest.",
            "hidden": f"The map is smooth down to its mesh: what counts as noise, {self.level:.3g}, may be the map's own. "
            f"{ONE_MAP}",
        }
        return {kind: sentences[kind] for kind in self.kinds}

    @property
    def facts(self) -> dict[str, Any]:
        """What is known in numbers, as a certificate holds it."""
        return {
            "standard_deviation": self.level,
            "kind": ", ".join(self.kinds) or "white",
            "outliers": len(self.outliers),
            "spread_of_level": self.spread,
            "full_width": self.width,
            "step": self.step or None,
            "measurements": self.measurements,
        }

    def __str__(self) -> str:
        rows = self._summary().rows()
        said = list(self.notes)
        if not self.kinds:
            said.append("The noise is white: of one level, and independent from vertex to vertex.")
        if len(self.outliers):
            more = ", ..." if len(self.outliers) > MOST_SHOWN else ""
            said.append(f"Outliers are at vertices {', '.join(map(str, self.outliers[:MOST_SHOWN]))}{more}.")
        return "\n".join([*(f"{name}: {value}" for name, value in rows.items()), *said])

    def _summary(self) -> Summary:
        return Summary(
            "noise of a map", {name.replace("_", " "): value for name, value in self.facts.items()}, self.notes
        )

    @property
    def weights(self) -> Floats:
        """(n,) precision over its median, between .1 and 10, and .1 for outliers: how much a value counts."""
        known = np.isfinite(self.levels)
        weights = np.ones(len(self.levels))
        if self.level > 0:
            weights[known] = (np.median(self.levels[known]) / self.levels[known]) ** 2
        weights = np.clip(weights, LEAST_WEIGHT, LARGEST_WEIGHT)
        weights[self.outliers] = LEAST_WEIGHT
        return weights

    def with_level(self, level: float) -> FittedNoise:
        """Return noise of the same kind with another standard deviation, such as one that is known.

        Parameters
        ----------
        level : float
            In the unit of the map.

        Returns
        -------
        FittedNoise
        """
        factor = level / self.level if self.level > 0 else 0.0
        levels = factor * self.levels if factor else np.where(np.isfinite(self.levels), level, np.nan)
        return replace(self, level=level, levels=levels)

    def in_unit(self, unit: float) -> FittedNoise:
        """Return the noise of the map times a factor.

        Parameters
        ----------
        unit : float
            The factor, positive.

        Returns
        -------
        FittedNoise
        """
        return replace(self, level=unit * self.level, levels=unit * self.levels, step=unit * self.step)

    def draw(self, operator: SurfaceOperator, seed: int) -> Floats:
        """Return (n,) noise of this kind, 0 at outliers: random signs, smooth where the noise is.

        Parameters
        ----------
        operator : SurfaceOperator
            Of the n vertices.
        seed : int

        Returns
        -------
        (n,) float64
        """
        signs = np.random.default_rng(seed).choice([-1.0, 1.0], (len(self.levels), 1))
        drawn = NoiseStatistics(operator).smooth_noise(signs, self.width / operator.edge_length)[:, 0] * self.levels
        drawn[self.outliers] = 0.0
        return drawn

    def on_whole(self, part: SurfacePart) -> FittedNoise:
        """Return the noise of a part as that of the whole surface, with the vertices and the unit of length of the whole.

        Parameters
        ----------
        part : SurfacePart
            On which it was read.

        Returns
        -------
        FittedNoise
        """
        return replace(
            self,
            levels=part.extend(self.levels),
            outliers=part.vertices[self.outliers],
            width=self.width * part.length,
        )

    def on_part(self, part: SurfacePart) -> FittedNoise:
        """Return the noise of a whole surface as that of a part of it.

        Parameters
        ----------
        part : SurfacePart

        Returns
        -------
        FittedNoise

        Raises
        ------
        ValueError
            If it was read on another surface or mask.
        """
        if len(self.levels) != part.whole_count:
            raise ValueError(
                f"noise was read from {len(self.levels)} values, the map has {part.whole_count}: read it from this map"
            )
        levels = self.levels[part.vertices]
        if unknown := int((~np.isfinite(levels)).sum()):
            raise ValueError(
                f"noise is not known at {unknown} of the {len(levels)} vertices of the map: read it inside the same mask"
            )
        outliers = np.flatnonzero(np.isin(part.vertices, self.outliers))
        return replace(self, levels=levels, outliers=outliers, width=self.width / part.length)


def varies(spread: float, growth: float, noise_alone: bool) -> bool:
    """Whether a spread of local levels is that of the noise, and not of a map that is rough in places."""
    return spread > VARYING and (noise_alone or growth <= ROUGH)
