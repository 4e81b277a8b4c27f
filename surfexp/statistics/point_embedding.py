"""Members of a collection as points of a plane or space."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric


@dataclass(frozen=True, eq=False)
class PointEmbedding:
    """Points whose distances are near to those of a collection.

    Parameters
    ----------
    points : (n, d) float64
    labels, classes, groups : tuple of str
        As in `DistanceMatrix`.
    method : str
    name : str
        What the distances measure, for captions.
    metrics : dict of str to float
        "stress" is Kruskal's, sqrt(sum (D - d)^2 / sum D^2) over all pairs.
    notes
        As in `Surface`.
    """

    points: Floats
    labels: tuple[str, ...]
    classes: tuple[str, ...]
    groups: tuple[str, ...]
    method: str = ""
    name: str = ""
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "stress": Metric("root of the squared misfit of the distances over their squares", better="lower"),
    }
