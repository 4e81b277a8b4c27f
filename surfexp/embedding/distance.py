"""What a distance between two surfaces is: a value, how certain it is, the basis that attains it and the map it gives."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.drawable import Drawable
from surfexp.contract.metric import Metric
from surfexp.contract.summary import Summary


@dataclass(frozen=True, eq=False, repr=False)
class Distance(Drawable):
    """The distance between two embedded surfaces.

    Parameters
    ----------
    value : float
    lower_bound : float
        No admissible basis gives less.
    optimal : bool
        Whether the bound proves that `basis` is best, to rounding.
    evaluations : int
        Evaluations of the objective or its bound.
    basis : (n, n) float64
        Orthogonal; target points times it are compared with source points. Diagonal where only signs are free.
    source_points, target_points : (s, n), (t, n) float64
        Both embeddings in the optimal basis.
    correspondence : (t,) int64
        Source vertex that each target vertex is mapped to.
    closed, bounds : (c, n) int8, (c,) float64
        The log of the search over signs (see `SignSearch`); empty where blocks were rotated.
    method : str
    metrics : dict of str to float
    notes : tuple of str
        As in `Surface`.
    """

    value: float
    lower_bound: float
    optimal: bool
    evaluations: int
    basis: Floats
    source_points: Floats
    target_points: Floats
    correspondence: Integers
    closed: Integers = field(default_factory=lambda: np.zeros((0, 0), np.int64))
    bounds: Floats = field(default_factory=lambda: np.zeros(0))
    method: str = ""
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "distance": Metric("the distance found"),
        "lower_bound": Metric("proved lower bound of the least distance", better="higher"),
        "gap": Metric("distance above its lower bound", better="lower"),
        "optimal": Metric("1 where the distance is proved least, else 0", better="higher"),
        "evaluations": Metric("evaluations of the distance or a bound", better="lower"),
        "label accuracy": Metric("share of the target's area that gets its own label", better="higher"),
        "label accuracy, vertices": Metric("share of the target's vertices that get their own label", better="higher"),
        "origin error": Metric("mean distance to the true vertex, over the root of the area", better="lower"),
    }

    def __post_init__(self) -> None:
        """Count value, bound and proof among the metrics, and refuse a map or a basis that does not fit."""
        n = self.source_points.shape[1]
        if self.basis.shape != (n, n) or self.target_points.shape[1] != n:
            shapes = f"basis {self.basis.shape}, target points {self.target_points.shape}"
            raise ValueError(f"{shapes} do not fit source points {self.source_points.shape}")
        if len(self.correspondence) != len(self.target_points):
            count = f"{len(self.correspondence)} entries for {len(self.target_points)} target points"
            raise ValueError(f"correspondence has {count}, one for each is needed")
        known = {
            "distance": self.value,
            "lower_bound": self.lower_bound,
            "gap": self.value - self.lower_bound,
            "optimal": float(self.optimal),
            "evaluations": float(self.evaluations),
        }
        object.__setattr__(self, "metrics", {**known, **self.metrics})

    def _summary(self) -> Summary:
        facts = {
            "distance": self.value,
            "lower bound": self.lower_bound,
            "proved least": self.optimal,
            "eigenfunctions": self.basis.shape[0],
            "vertices mapped": int((self.correspondence >= 0).sum()),
        }
        return Summary(f"spectral distance {self.method}".rstrip(), facts, self.notes)
