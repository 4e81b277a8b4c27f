"""Which metrics of a table are not a number: a cell shows them as one that is missing."""

from __future__ import annotations

import math

from surfexp.records.comparison import Comparison


def not_numbers(group: Comparison) -> list[str]:
    """Return a line for each metric of a table that is NaN in rows, with their number.

    Examples
    --------
    >>> from surfexp.records.table import Row
    >>> rows = [Row(None, {}, {"rmse": value}, None) for value in (1.0, math.nan)] + [Row(None, {}, {}, None)]
    >>> not_numbers(Comparison("", "", rows, ["rmse"]))
    ['rmse is NaN in 1 of 3 rows: its method gave no number there']
    """
    found = []
    for name in group.metric_names:
        if count := sum(math.isnan(row.metrics.get(name, 0.0)) for row in group.rows):
            of = f"{count} of {len(group.rows)} rows" if len(group.rows) > 1 else "its row"
            found.append(f"{name.replace('_', ' ')} is NaN in {of}: its method gave no number there")
    return found
