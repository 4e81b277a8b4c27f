"""A map by parcels: a table of means by area, and numbers of parcels as a map again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.given_arrays import real_array


@dataclass(frozen=True, eq=False, repr=False)
class Parcels(Drawable):
    """A map by parcels, one row for each parcel of each hemisphere.

    Parameters
    ----------
    names : tuple of str
    hemispheres : tuple of str
        "left" and "right", or nothing where the surface does not say it.
    vertices : (k,) int64
        How many.
    areas : (k,) float64
        Of the vertices, a third of each face around them; in the squared unit of the surface.
    means, medians : (k,) or (k, c) float64
        Weighted by area, over vertices where the map is known; NaN where it is known nowhere.
    unknown : (k,) or (k, c) float64
        Share of the area where the map is NaN.
    rows : (n,) int64
        The row of each vertex, -1 where there is none.
    notes : tuple of str
    channels : tuple of str
        Names of the c maps; numbers from 0 where there are none.
    """

    names: tuple[str, ...]
    hemispheres: tuple[str, ...]
    vertices: Integers
    areas: Floats
    means: Floats
    medians: Floats
    unknown: Floats
    rows: Integers
    notes: tuple[str, ...] = ()
    channels: tuple[str, ...] = ()

    @property
    def values(self) -> Floats:
        """(n,) or (n, c) map that has at each vertex the mean of its parcel, NaN elsewhere."""
        return self.on_surface(self.means)

    def on_surface(self, numbers: ArrayLike) -> Floats:
        """Return numbers of parcels as a map.

        Parameters
        ----------
        numbers : (k,) or (k, c) array_like

        Returns
        -------
        (n,) or (n, c) float64
            NaN outside of all parcels.

        Raises
        ------
        ValueError
            If there is not one row for each parcel.

        Examples
        --------
        >>> import surfexp as sx
        >>> ball = sx.shape("icosphere", levels=2)
        >>> found = sx.parcels(ball, ball.mesh.vertices[:, 2], (ball.mesh.vertices[:, 2] > 0).astype(int) + 1)
        >>> np.unique(found.on_surface([10.0, 20.0])).tolist()
        [10.0, 20.0]
        """
        given = real_array(numbers, "numbers")
        if given.shape[:1] != (len(self.names),):
            raise ValueError(f"numbers have shape {given.shape}, there are {len(self.names)} parcels")
        whole = np.full((len(self.rows), *given.shape[1:]), np.nan)
        inside = self.rows >= 0
        whole[inside] = given[self.rows[inside]]
        return whole

    def table(self) -> dict[str, list[Any]]:
        """Return columns as pandas.DataFrame takes them; of a map with channels, one mean, median and share for each.

        Returns
        -------
        dict of str to list
        """
        columns: dict[str, list[Any]] = {"hemisphere": list(self.hemispheres)} if any(self.hemispheres) else {}
        columns |= {"parcel": list(self.names), "vertices": self.vertices.tolist(), "area": self.areas.tolist()}
        for name, numbers in (("mean", self.means), ("median", self.medians), ("unknown", self.unknown)):
            columns |= {key: one.tolist() for key, one in self._of_channels(name, numbers).items()}
        return columns

    def named(self, name: str) -> dict[str, Floats]:
        """Return the means on the surface, each map by a name and its own.

        Parameters
        ----------
        name : str

        Returns
        -------
        dict of str to (n,) or (n, c) float64
            One of c columns where maps have no names.
        """
        return self._of_channels(name, self.values) if self.channels else {name: self.values}

    def _of_channels(self, name: str, numbers: Floats) -> dict[str, Floats]:
        if numbers.ndim == 1:
            return {name: numbers}
        channels = self.channels or range(numbers.shape[1])
        return {f"{name} {one}": numbers[:, k] for k, one in enumerate(channels)}

    def _summary(self) -> Summary:
        facts = {"parcels": len(self.names), "area": float(self.areas.sum()), "vertices": int(self.vertices.sum())}
        return Summary("map by parcels", facts, self.notes)
