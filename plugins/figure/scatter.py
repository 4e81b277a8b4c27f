"""A collection as points, figures 4.2, 4.6, 4.7 and 4.8."""

from typing import Annotated, Any

import numpy as np
from pydantic import Field
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from surfexp.contract.metric import Metric
from surfexp.figures.axes import FONT, SPACING, add_axes, class_style, spread
from surfexp.figures.figure import Figure
from surfexp.figures.typography import canvas, drawn, vector
from surfexp.figures.typography import points as text_size
from surfexp.lab.registry.registry import register
from surfexp.statistics.point_embedding import PointEmbedding

# right end of the axes, the classes stand beyond it
LEGEND = 0.78


METRICS = {
    "stress": Metric("root of the squared misfit of the distances over their squares", better="lower"),
}


@register("figure", "scatter", metrics=METRICS)
def scatter_figure(
    embedding: PointEmbedding,
    *,
    title: Annotated[str, Field(description="heading in the figure; default: the method and what is compared")] = "",
    caption: Annotated[str, Field(description="sentence below the figure")] = "",
    names: Annotated[bool, Field(description="write the label of each member beside its point")] = False,
    width: Annotated[int, Field(ge=300, le=4000, description="pixels across")] = 1000,
) -> Figure:
    """The first two coordinates of an embedding, a colour and a marker for each class."""
    points = embedding.points[:, :2] if embedding.points.shape[1] > 1 else np.pad(embedding.points, [(0, 0), (0, 1)])
    title = title or f"{embedding.method} of {embedding.name.replace('_', ' ')}"
    classes, em = np.asarray(embedding.classes), FONT * width
    with canvas(width, round(0.68 * width)) as figure:
        axes = add_axes(figure, title, "first coordinate", "second coordinate")
        box = axes.get_position()
        axes.set_position([box.x0, box.y0, LEGEND - box.x0, box.height])
        for k, name in enumerate(dict.fromkeys(embedding.classes)):
            color, marker = class_style(k)
            axes.scatter(*points[classes == name].T, s=42, c=color, marker=marker, alpha=0.85, linewidths=0, label=name)
        axes.set_aspect("equal", adjustable="datalim")
        if names:
            _write_labels(axes, embedding, points)
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), frameon=False, fontsize=text_size(em))
        pixels, svg = drawn(figure), vector(figure)
    caption = caption or "Each point is a shape; only distances mean something, axes may be turned or mirrored."
    caption = f"{caption} {_share_shown(embedding)}".strip()
    return Figure(pixels, caption, title, {"stress": embedding.metrics.get("stress", 0.0)}, svg=svg)


def _share_shown(embedding: PointEmbedding) -> str:
    """How much of the distances the points hold: their share of the variance, or else the stress."""
    if (share := embedding.metrics.get("explained")) is not None:
        return f"The points hold {share:.0%} of the variance."
    if (stress := embedding.metrics.get("stress")) is not None:
        return f"The distances of the points are {stress:.0%} off (stress)."
    return ""


def _write_labels(axes: Any, embedding: PointEmbedding, points: np.ndarray) -> None:
    axes.figure.canvas.draw()
    places, size = axes.transData.transform(points), text_size(0.8 * FONT * axes.figure.bbox.width)
    line = SPACING * 0.8 * FONT * axes.figure.bbox.width
    # names that would stand on one another are moved apart and joined to their points
    reach, heights = 0.45 * max(map(len, embedding.labels)) * line, places[:, 1].copy()
    for group in _neighbours(places, reach, line):
        heights[group] = spread(places[group, 1], line)
    for label, point, place, height in zip(embedding.labels, points, places, heights, strict=True):
        moved = abs(height - place[1]) > 0.3 * line
        axes.annotate(
            label,
            point,
            xytext=(text_size(12.0 if moved else 8.0), text_size(height - place[1])),
            textcoords="offset points",
            fontsize=size,
            color="#555555",
            va="center",
            arrowprops={"arrowstyle": "-", "linewidth": 0.6, "color": "#999999", "shrinkA": 0.0} if moved else None,
        )


def _neighbours(places: np.ndarray, reach: float, line: float) -> list[np.ndarray]:
    """Rows of the points whose names, `reach` long, would touch."""
    apart = np.abs(places[:, None] - places[None])
    touching = (apart[:, :, 0] < reach) & (apart[:, :, 1] < line)
    labels = connected_components(csr_array(touching))[1]
    return [np.flatnonzero(labels == k) for k in range(labels.max() + 1)]
