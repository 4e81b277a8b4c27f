"""The figure that only a report can draw, since clocks are in the events of stages: gap against seconds."""

from __future__ import annotations

from statistics import median

import numpy as np

from surfexp.figures.cost_plot import cost_plot
from surfexp.figures.figure import Figure
from surfexp.records.comparison import Comparison
from surfexp.records.written_numbers import short_name

GAP, METHOD, TOLERANCE = "relative_gap", "solver.name", "solver.tolerance"


def cost_figure(group: Comparison) -> Figure | None:
    """Draw certified gap against seconds where a comparison has several solvers at several tolerances, else nothing."""
    found: dict[str, dict[str, list[tuple[float, float]]]] = {}
    for row in group.rows:
        gap = row.metrics.get(GAP, 0.0)
        if gap > 0.0 and row.seconds and not row.failure and TOLERANCE in row.parameters:
            places = found.setdefault(str(row.parameters[METHOD]).replace("_", " "), {})
            places.setdefault(str(row.parameters[TOLERANCE]), []).append((gap, row.seconds))
    if len(found) < 2 or sum(len(places) > 1 for places in found.values()) < 2:
        return None
    methods = {}
    for name, places in found.items():
        gaps = np.array([median(gap for gap, _ in runs) for runs in places.values()])
        clocks = [[clock for _, clock in runs] for runs in places.values()]
        methods[name] = gaps, np.array([(median(times), min(times), max(times)) for times in clocks])
    return cost_plot(methods, title="Cost", caption=_caption(group))


def _caption(group: Comparison) -> str:
    """What else differs between the rows of a method and tolerance is what its band goes over."""
    others = [short_name(name) for name in group.varying if name not in (METHOD, TOLERANCE)]
    band = f"; of each the median, and as a band the range, over {', '.join(others)}" if others else ""
    kinds = f" on {len(group.machines)} kinds of machine" if len(group.machines) > 1 else ""
    return f"Measured{kinds}, one run for each row{band}."
