"""What a permutation test found: maps of statistics and p-values, and a table of clusters."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary


@dataclass(frozen=True)
class TestedCluster:
    """Connected vertices of one sign.

    Parameters
    ----------
    vertices : int
        How many.
    area : float
        In the squared unit of the surface.
    mass : float
        Sum of |t| times area.
    peak : int
        Vertex of the largest |t|. Of both hemispheres right vertices count on behind the left ones.
    place : tuple of float
        Coordinates of the peak.
    t : float
        At the peak, with its sign.
    p_t, p_tfce : float
        Family-wise, the smallest of its vertices.
    p_extent, p_mass : float
        Family-wise, of the whole cluster; NaN for a region that no threshold has formed.
    parcels : dict of str to float
        Share of the area in each parcel, largest first, where labels are given.
    hemisphere : {"", "left", "right"}
    """

    __test__ = False

    vertices: int
    area: float
    mass: float
    peak: int
    place: tuple[float, float, float]
    t: float
    p_t: float
    p_tfce: float
    p_extent: float = float("nan")
    p_mass: float = float("nan")
    parcels: dict[str, float] = field(default_factory=dict)
    hemisphere: str = ""


@dataclass(frozen=True, eq=False, repr=False)
class PermutationTest(Drawable):
    """Maps of a test at every vertex; NaN outside the mask.

    Each of the four family-wise tests keeps its level over all vertices. Decide for one before you look: the least of four
    p-values is no p-value.

    Parameters
    ----------
    t : (n,) float64
        Statistic of the contrast.
    tfce : (n,) float64
        Its exact threshold-free cluster enhancement.
    p_t, p_tfce : (n,) float64
        Family-wise p-values, by the largest statistic of each rearrangement.
    p_extent, p_mass : (n,) float64
        Family-wise p-value of the cluster of each vertex, by area and by mass; 1 outside of clusters.
    q_t, q_tfce : (n,) float64
        Uncorrected p-values of the rearrangements, adjusted by Benjamini and Hochberg for the false discovery rate.
    clusters : tuple of TestedCluster
        Beyond the threshold, by falling mass.
    regions : tuple of TestedCluster
        Connected vertices whose p_tfce is at most the level, by falling mass; they need no threshold.
    null : dict of str to (r,) float64
        Largest "t", "tfce", "extent" and "mass" of each rearrangement.
    level : float
    facts : dict
        What was tested, and by which rearrangements.
    notes : tuple of str
    """

    t: Floats
    tfce: Floats
    p_t: Floats
    p_tfce: Floats
    p_extent: Floats
    p_mass: Floats
    q_t: Floats
    q_tfce: Floats
    clusters: tuple[TestedCluster, ...]
    regions: tuple[TestedCluster, ...]
    null: dict[str, Floats]
    level: float
    facts: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def maps(self) -> dict[str, Floats]:
        """All maps by name, as `surfexp.write` takes them."""
        names = ("t", "tfce", "p_t", "p_tfce", "p_extent", "p_mass", "q_t", "q_tfce")
        return {name: getattr(self, name) for name in names}

    @property
    def values(self) -> Floats:
        """The map of t."""
        return self.t

    def table(self, which: str = "clusters") -> dict[str, list[Any]]:
        """Return clusters or regions as columns, as pandas.DataFrame takes them.

        Parameters
        ----------
        which : {"clusters", "regions"}

        Returns
        -------
        dict of str to list
            Parcels are one text, "name 62 %, name 38 %".

        Raises
        ------
        ValueError
            If it is neither.
        """
        from surfexp.mesh.given_numbers import one_of

        rows = getattr(self, one_of(which, "which", ("clusters", "regions")))
        columns: dict[str, list[Any]] = {
            name: [getattr(row, name) for row in rows] for name in ("vertices", "area", "mass", "peak")
        }
        columns |= {axis: [row.place[k] for row in rows] for k, axis in enumerate("xyz")}
        columns |= {name: [getattr(row, name) for row in rows] for name in ("t", "p_t", "p_tfce")}
        if which == "clusters":
            columns |= {name: [getattr(row, name) for row in rows] for name in ("p_extent", "p_mass")}
        if any(row.hemisphere for row in rows):
            columns = {"hemisphere": [row.hemisphere for row in rows], **columns}
        if any(row.parcels for row in rows):
            columns["parcels"] = [
                ", ".join(f"{name} {share:.0%}" for name, share in row.parcels.items()) for row in rows
            ]
        return columns

    def _summary(self) -> Summary:
        smallest = {name: float(np.nanmin(self.maps[name])) for name in ("p_t", "p_tfce", "p_extent", "p_mass")}
        return Summary("permutation test", self.facts | smallest | {"regions by tfce": len(self.regions)}, self.notes)
