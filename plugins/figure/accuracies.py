"""Accuracies of several classifications with their intervals."""

from pydantic import Field

from surfexp.figures.figure import Figure
from surfexp.figures.interval_plot import interval_plot
from surfexp.statistics.classification import Classification
from surfexp.workflow.registry import Options, register


class Accuracies(Options):
    """What is written above and below."""

    title: str = Field("", description="heading in the figure; default: the method, if it is one")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "accuracies")
def accuracies_figure(options: Accuracies, *, classifiers: dict[str, Classification]) -> Figure:
    """Accuracy of each member of an axis with its bootstrap interval, chance as a dashed line."""
    intervals = {
        label: (found.metrics["accuracy"], found.metrics["accuracy_low"], found.metrics["accuracy_high"])
        for label, found in classifiers.items()
    }
    chances = [found.metrics["chance"] for found in classifiers.values() if "chance" in found.metrics]
    reference = sum(chances) / len(chances) if chances else None
    caption = options.caption or "Share of members given their class, with 95 % bootstrap intervals over groups."
    if any(low == high for _, low, high in intervals.values()):
        caption += " Without an error in the sample an interval has no width; it does not prove that there is none."
    methods = {found.method.replace("_", " ") for found in classifiers.values()}
    title = options.title or (methods.pop() if len(methods) == 1 else "")
    return interval_plot(intervals, x_label="accuracy", reference=reference, title=title, caption=caption)
