"""Accuracies of several classifications with their intervals."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import MetricName
from surfexp.figures.figure import Figure
from surfexp.figures.interval_plot import interval_plot
from surfexp.lab.registry.registry import register
from surfexp.statistics.classification import Classification


@register("figure", "accuracies", defaults_of=interval_plot)
def accuracies_figure(
    classifiers: dict[str, Classification],
    *,
    metric: Annotated[
        MetricName, Field(description="metric of the classifications; with _low and _high its interval")
    ] = "accuracy",
    title: Annotated[str, Field(description="heading in the figure; default: the method, if it is one")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Accuracy, or another share, of each member of an axis with its interval; chance as a dashed line."""
    name = metric
    intervals = {label: _interval(found.metrics, name, label) for label, found in classifiers.items()}
    chances = [found.metrics["chance"] for found in classifiers.values() if "chance" in found.metrics]
    reference = sum(chances) / len(chances) if chances and name == "accuracy" else None
    caption = caption or "Share of members given their class, with 95 % bootstrap intervals over groups."
    if name == "accuracy" and any(low == high for _, low, high in intervals.values()):
        caption += " Without an error in the sample an interval has no width; it does not prove that there is none."
    methods = {found.method.replace("_", " ") for found in classifiers.values()}
    title = title or (methods.pop() if len(methods) == 1 else "")
    shown = name.replace("_", " ")
    return interval_plot(
        intervals, x_label=shown, reference=reference, reference_name="chance", title=title, caption=caption
    )


def _interval(metrics: dict[str, float], name: str, label: str) -> tuple[float, float, float]:
    if name not in metrics:
        raise ValueError(f"classification {label!r} has no metric {name!r}, choose one of {', '.join(sorted(metrics))}")
    value = metrics[name]
    return value, metrics.get(f"{name}_low", value), metrics.get(f"{name}_high", value)
