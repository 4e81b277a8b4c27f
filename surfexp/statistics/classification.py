"""What a classifier found, each member judged by a rule that never saw its person or object."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from surfexp.contract.arrays import Integers
from surfexp.contract.metric import Metric


@dataclass(frozen=True, eq=False)
class Classification:
    """Predictions of grouped cross-validation.

    Parameters
    ----------
    labels, classes, groups : tuple of str
        As in `DistanceMatrix`.
    predicted : tuple of str
        The class that each member was given while its group was left out.
    names : tuple of str
        The classes, sorted: rows and columns of the confusion matrix.
    confusion : (c, c) int64
        Members of the class of the row that were given the class of the column.
    method : str
    name : str
        What was compared, for captions.
    metrics : dict of str to float
        "accuracy", "accuracy_low" and "accuracy_high" (95 % bootstrap over groups), "chance" (mean accuracy over
        permuted labels), "p_value", ...
    notes
        As in `Surface`.
    """

    labels: tuple[str, ...]
    classes: tuple[str, ...]
    groups: tuple[str, ...]
    predicted: tuple[str, ...]
    names: tuple[str, ...]
    confusion: Integers
    method: str = ""
    name: str = ""
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "accuracy": Metric("share of members classified right, their own group left out", better="higher"),
        "accuracy_low": Metric("lower end of the 95 % bootstrap interval of the accuracy"),
        "accuracy_high": Metric("upper end of the 95 % bootstrap interval of the accuracy"),
        "balanced_accuracy": Metric("mean over classes of the share classified right", better="higher"),
        "silhouette": Metric("mean silhouette of the classes", better="higher"),
        "between_within": Metric("mean distance between classes over that inside them", better="higher"),
        "chance": Metric("mean accuracy under permuted classes"),
        "p_value": Metric("permutation test of the accuracy", better="lower"),
        "nearest_neighbour": Metric("share of queries whose nearest answer is of their class", better="higher"),
        "first_tier": Metric("share of the c others of a class among the first c answers", better="higher"),
        "second_tier": Metric("share of the c others of a class among the first 2 c answers", better="higher"),
        "mean_average_precision": Metric("mean over queries of the average precision", better="higher"),
    }
