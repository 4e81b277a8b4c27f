"""What a classifier found, each member judged by a rule that never saw its person or object."""

from __future__ import annotations

from dataclasses import dataclass, field

from surfexp.mesh.triangle_mesh import Integers


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
