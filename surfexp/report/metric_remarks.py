"""What a reader of a table has to know of its metrics: which are not a number, and which seconds do not compare."""

from __future__ import annotations

import math

from surfexp.records.comparison import Comparison
from surfexp.records.table import SECONDS


def metric_remarks(group: Comparison, with_seconds: bool = False) -> list[str]:
    """Return a line for each metric of a table that is NaN in rows, with their number, and one for seconds of several machines.

    `with_seconds` says that the table shows seconds though nobody asked for them.

    Examples
    --------
    >>> from surfexp.records.table import Row
    >>> rows = [Row(None, {}, {"rmse": value}, None) for value in (1.0, math.nan)] + [Row(None, {}, {}, None)]
    >>> metric_remarks(Comparison("", "", rows, ["rmse"]))
    ['rmse is NaN in 1 of 3 rows: its method gave no number there']
    >>> rows = [Row(None, {}, {}, 1.0, machine=kind) for kind in ("old, 2 cores", "new, 8 cores", "new, 8 cores")]
    >>> metric_remarks(Comparison("", "", rows, ["seconds"]))
    ['seconds are of 2 kinds of machine and compare only within one: new, 8 cores (2 rows); old, 2 cores (1 row)']
    """
    found = []
    for name in group.metric_names:
        if count := sum(math.isnan(row.metrics.get(name, 0.0)) for row in group.rows):
            of = f"{count} of {len(group.rows)} rows" if len(group.rows) > 1 else "its row"
            found.append(f"{name.replace('_', ' ')} is NaN in {of}: its method gave no number there")
    if (with_seconds or SECONDS in group.metric_names) and len(group.machines) > 1:
        kinds = "; ".join(f"{kind} ({count} row{'s' * (count > 1)})" for kind, count in sorted(group.machines.items()))
        found.append(f"seconds are of {len(group.machines)} kinds of machine and compare only within one: {kinds}")
    return found
