"""Distances between all members of a collection."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric


@dataclass(frozen=True, eq=False)
class DistanceMatrix:
    """A symmetric matrix of distances, checked when it is made.

    Parameters
    ----------
    labels : tuple of str
        Names of the n members, for people.
    values : (n, n) float64
        Distances; symmetric, not negative, 0 on the diagonal.
    classes : tuple of str, optional
        The class of each member; default: each of its own.
    groups : tuple of str, optional
        The person or object to which each belongs; default: each to its own.
    coordinates : (n, d) float64, optional
        Points whose Euclidean distances these are, where there are such.
    name : str
        What is measured, for captions.
    metrics, notes
        As in `Surface`.

    Raises
    ------
    ValueError
        If the matrix is not n x n, not symmetric, not finite, negative or not 0 on the diagonal.
    """

    labels: tuple[str, ...]
    values: Floats
    classes: tuple[str, ...] = ()
    groups: tuple[str, ...] = ()
    coordinates: Floats | None = None
    name: str = ""
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "members": Metric("members of the collection"),
        "length": Metric("entries of a signature that are compared"),
        "between_within": Metric("mean distance between classes over that inside them", better="higher"),
        "silhouette": Metric("mean silhouette of the classes", better="higher"),
    }

    def __post_init__(self) -> None:
        object.__setattr__(self, "classes", self.classes or self.labels)
        object.__setattr__(self, "groups", self.groups or self.labels)
        n, values = len(self.labels), self.values
        if values.shape != (n, n) or len(self.classes) != n or len(self.groups) != n:
            sizes = f"{len(self.classes)} classes and {len(self.groups)} groups"
            raise ValueError(f"distances have shape {values.shape}, {n} labels, {sizes}; the numbers must agree")
        scale = max(float(np.abs(values).max(initial=0.0)), 1e-300)
        if not np.isfinite(values).all():
            raise ValueError(f"{int((~np.isfinite(values)).sum())} of the {n} x {n} distances are not finite")
        skew = float(np.abs(values - values.T).max(initial=0.0))
        if (
            skew > 1e-9 * scale
            or values.min(initial=0.0) < 0.0
            or np.abs(np.diag(values)).max(initial=0.0) > 1e-9 * scale
        ):
            raise ValueError(f"distances must be symmetric, not negative and 0 to oneself; asymmetry {skew:.1e}")
