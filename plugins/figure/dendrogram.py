"""A collection as a tree of clusters."""

from typing import Annotated

from pydantic import Field
from scipy.cluster import hierarchy
from scipy.spatial.distance import squareform

from surfexp.figures.axes import add_axes, class_style
from surfexp.figures.figure import Figure
from surfexp.figures.typography import canvas, drawn, points, vector
from surfexp.lab.registry.registry import register
from surfexp.statistics.distance_matrix import DistanceMatrix


@register("figure", "dendrogram")
def dendrogram_figure(
    distance_matrix: DistanceMatrix,
    *,
    linkage: Annotated[str, Field(description="scipy's name of the linkage: average, complete, single")] = "average",
    title: Annotated[str, Field(description="heading in the figure; default: what is compared")] = "",
    caption: Annotated[str, Field(description="sentence below the figure")] = "",
    width: Annotated[int, Field(ge=300, le=4000, description="pixels across")] = 1100,
) -> Figure:
    """Hierarchical clustering of a collection by its distances, names and marks coloured by class."""
    title = title or f"clusters by {distance_matrix.name.replace('_', ' ')}"
    tree = hierarchy.linkage(squareform(distance_matrix.values, checks=False), linkage)
    classes = list(dict.fromkeys(distance_matrix.classes))
    count = len(distance_matrix.labels)
    with canvas(width, round(width * (0.16 + 0.034 * count))) as figure:
        axes = add_axes(figure, title, "distance at which clusters join", "")
        size = points(0.0155 * width)
        drawing = hierarchy.dendrogram(
            tree, ax=axes, orientation="left", labels=list(distance_matrix.labels), color_threshold=0.0,
            above_threshold_color="#555555",
        )  # fmt: skip
        axes.grid(False)
        for side in ("left", "right", "top"):
            axes.spines[side].set_visible(False)
        axes.tick_params(axis="y", labelsize=size, length=0, pad=0.8 * size)
        for text, place, member in zip(axes.get_yticklabels(), axes.get_yticks(), drawing["leaves"], strict=True):
            color, marker = class_style(classes.index(distance_matrix.classes[member]))
            text.set_color(color)
            axes.plot([0.0], [place], color=color, marker=marker, clip_on=False, zorder=3.0)
        box = axes.get_position()
        axes.set_position((0.03, box.y0, 0.955 - 0.013 * max(map(len, distance_matrix.labels)), box.height))
        pixels, svg = drawn(figure), vector(figure)
    caption = caption or "Each leaf is a shape; clusters join at the mean distance of their members."
    return Figure(pixels, caption, title, svg=svg)
