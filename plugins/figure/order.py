"""Order of convergence under refinement."""

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric, MetricName
from surfexp.figures.figure import Figure
from surfexp.figures.order_plot import order_plot
from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.statistic import Statistic


class Order(Options):
    """Which errors are drawn against the mesh size."""

    errors: dict[str, MetricName] = Field(description="metric of each line, by its label")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


METRICS = {
    "order {line}": Metric("order of convergence", better="higher"),
}


@register("figure", "order", metrics=METRICS)
def order_figure(options: Order, *, statistics: dict[str, Statistic]) -> Figure:
    """Errors over the edge length along an axis of refinement, with the measured orders."""
    results = list(statistics.values())
    sizes = np.array([result.metrics["edge_length"] for result in results])
    lines = {label: np.array([result.metrics[name] for result in results]) for label, name in options.errors.items()}
    title = " · ".join(part for part in (options.title, results[0].name.replace("_", " ")) if part)
    return order_plot(sizes, lines, y_label="relative error", title=title, caption=options.caption)
