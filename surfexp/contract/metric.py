"""What a number in a table means: a metric as plugins declare it and results carry it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal

NAMES_METRIC = "names a metric of an input"
MetricName = Annotated[str, NAMES_METRIC]


@dataclass(frozen=True)
class Metric:
    """The meaning of a metric.

    Parameters
    ----------
    meaning : str
        What it is, in a few words.
    unit : str, optional
        Its unit; empty for counts, shares, and numbers without unit.
    better : "lower", "higher" or ""
        The good direction; empty where there is none.
    bound : str, optional
        Name of the option of the stage that the metric must not exceed in a result that counts as converged.
    """

    meaning: str
    unit: str = ""
    better: Literal["lower", "higher", ""] = ""
    bound: str = ""


def find_metric(name: str, declared: Mapping[str, Metric]) -> Metric | None:
    """The declaration of a metric, or None.

    A declared name may have a placeholder for what only an experiment knows: "dice {reference}" declares "dice sulc".
    """
    if name in declared:
        return declared[name]
    return next((metric for pattern, metric in declared.items() if "{" in pattern and _fits(name, pattern)), None)


def _fits(name: str, pattern: str) -> bool:
    return re.fullmatch(re.sub(r"\\\{\w+\\\}", ".+", re.escape(pattern)), name) is not None
