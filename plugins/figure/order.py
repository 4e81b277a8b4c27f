"""Order of convergence under refinement."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric, MetricName
from surfexp.figures.figure import Figure
from surfexp.figures.order_plot import order_plot
from surfexp.lab.registry.registry import register
from surfexp.statistics.measurement import Measurement

METRICS = {
    "order {line}": Metric("order of convergence", better="higher"),
}


@register("figure", "order", metrics=METRICS, defaults_of=order_plot)
def order_figure(
    measurements: dict[str, Measurement],
    *,
    errors: Annotated[dict[str, MetricName], Field(description="metric of each line, by its label")],
    title: Annotated[str, Field(description="heading in the figure")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Errors over the edge length along an axis of refinement, with the measured orders."""
    results = list(measurements.values())
    sizes = np.array([result.metrics["edge_length"] for result in results])
    lines = {label: np.array([result.metrics[name] for result in results]) for label, name in errors.items()}
    title = " · ".join(part for part in (title, results[0].subject.replace("_", " ")) if part)
    return order_plot(sizes, lines, y_label="relative error", title=title, caption=caption)
