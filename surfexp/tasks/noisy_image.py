"""A map and its noise, as every model of denoising takes them: from what a person hands in to numbers inside the mask."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.given_numbers import real_number
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.absurd_values import refuse_absurd_values
from surfexp.tasks.given_map import MapLike, as_map, name_of
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for
from surfexp.variational.fitted_noise import FittedNoise
from surfexp.variational.noise_level import noise_level
from surfexp.variational.noise_reading import read_noise


@dataclass(frozen=True, eq=False)
class NoisyImage:
    """A map inside the mask of a surface.

    Parameters
    ----------
    part : SurfacePart
    operator : SurfaceOperator
        On the part.
    values : (p,) or (p, c) float64
        One column is (p,).
    given_noise : float, optional
        Standard deviation, as the caller says.
    known_noise : FittedNoise, optional
        On the part, as it was read before: from two measurements, say.
    name : str
        Under which the surface carries the map.
    is_column : bool
        Whether the map was given as one column, so that results are columns too.
    """

    part: SurfacePart
    operator: SurfaceOperator
    values: Floats
    given_noise: float | None
    known_noise: FittedNoise | None
    name: str
    is_column: bool = False

    def on_whole(self, values: Floats) -> Floats:
        """Return values inside the mask as a map of the whole surface, in the shape of the one that was given.

        Parameters
        ----------
        values : (p,) or (p, c) float64

        Returns
        -------
        (n,), (n, 1) or (n, c) float64
            NaN outside the mask.
        """
        whole = self.part.extend(values)
        return whole[:, None] if self.is_column else whole

    def noise(self) -> tuple[float, tuple[str, ...]]:
        """Return the noise, as given or read from the map, and what is to be said of it.

        Several channels are pooled, and nothing is said of them.

        Raises
        ------
        ValueError
            If the map has no noise.
        """
        notes: tuple[str, ...] = ()
        level = self.given_noise
        if self.values.ndim == 1:
            found = self.known_noise or read_noise(self.operator, self.values, level=level)
            level, notes = (found.level if level is None else level), found.notes
        elif level is None:
            level = noise_level(self.operator, self.values)
        if not level > 0:
            raise ValueError(f"noise is {level:g}, it must be positive: give the noise of the map")
        return level, notes

    def data_weight(self, weight: float, noise: float) -> float:
        """Return mu of the model TV(u) + mu/2 |u - f|^2 for a dimensionless weight."""
        return weight / (noise * self.operator.edge_length)


def noisy_image(surface: SurfaceLike, values: MapLike, noise: float | FittedNoise | None) -> NoisyImage:
    """Check a map and cut it out of its surface.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
    values : str or (n,) or (n, c) float64
    noise : float or FittedNoise, optional

    Raises
    ------
    ValueError
        If the map does not fit, has values far from all others, or is constant while its noise is not given; if noise was read
        on another surface or mask.
    """
    owner = as_surface(surface)
    noisy = as_map(owner, values)
    part = part_for(owner, noisy)
    is_column = noisy.ndim == 2 and noisy.shape[1] == 1
    image = np.asarray(part.restrict(noisy.reshape(-1) if is_column else noisy), dtype=np.float64)
    refuse_absurd_values(image, part.vertices)
    if np.ptp(image) == 0 and noise is None:
        raise ValueError(f"map is constant at {image.flat[0]:g}: it has no noise to remove")
    known = noise.on_part(part) if isinstance(noise, FittedNoise) else None
    level = noise if known is None else known.level
    given = None if level is None else real_number(level, "noise", above=0.0)
    return NoisyImage(part, fem(part.mesh), image, given, known, name_of(values), is_column)
