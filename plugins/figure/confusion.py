"""The confusion matrix of a classifier."""

from typing import Annotated

from pydantic import Field

from surfexp.figures.axes import FONT
from surfexp.figures.figure import Figure
from surfexp.figures.typography import INK, QUIET, canvas, drawn, points, vector
from surfexp.lab.registry.registry import register
from surfexp.statistics.classification import Classification


@register("figure", "confusion")
def confusion_figure(
    classifier: Classification,
    *,
    title: Annotated[str, Field(description="heading in the figure; default: the method and what is compared")] = "",
    caption: Annotated[str, Field(description="sentence below the figure")] = "",
    width: Annotated[int, Field(ge=300, le=4000, description="pixels across")] = 900,
) -> Figure:
    """How many members of each class were given which class, by a rule that never saw their group."""
    names, counts = classifier.names, classifier.confusion
    number = len(names)
    title = title or f"{classifier.name} · {classifier.method}".replace("_", " ")
    em = FONT * width
    shares = counts / counts.sum(axis=1, keepdims=True)
    with canvas(width, round(width * 0.78)) as figure:
        axes = figure.add_axes((0.24, 0.2, 0.7, 0.68))
        axes.grid(visible=False)
        axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
        for i in range(number):
            for j in range(number):
                color = "white" if shares[i, j] > 0.55 else INK if counts[i, j] else QUIET
                axes.text(j, i, f"{counts[i, j]}", ha="center", va="center", color=color, fontsize=points(1.1 * em))
        axes.set_xticks(range(number), names, rotation=30, ha="right")
        axes.set_yticks(range(number), names)
        axes.tick_params(labelsize=points(em), length=0.0)
        axes.spines[:].set_visible(False)
        axes.set_xlabel("class given", fontsize=points(em))
        axes.set_ylabel("true class", fontsize=points(em))
        axes.set_title(title, fontsize=points(1.1 * em), fontweight="bold", pad=points(0.9 * em))
        pixels, svg = drawn(figure), vector(figure)
    numbers = classifier.metrics
    caption = caption or (
        f"Accuracy {numbers['accuracy']:.2f} (95 % interval {numbers['accuracy_low']:.2f} to "
        f"{numbers['accuracy_high']:.2f}); groups never stand in training and test sets at once."
    )
    return Figure(pixels, caption, title, svg=svg)
