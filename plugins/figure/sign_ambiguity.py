"""The embeddings that signs allow, figure 6.2."""

from itertools import product
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.distance import Distance
from surfexp.embedding.nearest import mutual_distances
from surfexp.figures.axes import COLORS
from surfexp.figures.figure import Figure, compare
from surfexp.figures.typography import canvas, drawn, points
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface

METRICS = {
    "least": Metric("least distance over all signs"),
    "next": Metric("second least distance over all signs"),
}


@register("figure", "sign_ambiguity", metrics=METRICS)
def sign_ambiguity_figure(
    source_surface: Surface,
    target_surface: Surface,
    distance: Distance,
    *,
    n: Annotated[int, Field(ge=2, le=4, description="eigenfunctions; 2^n panels")] = 3,
    dots: Annotated[int, Field(ge=100, le=20000, description="points of each surface that are drawn")] = 1500,
    reference: Annotated[str, Field(description="figure of the dissertation that this one answers")] = "",
    width: Annotated[int, Field(ge=400, le=6000, description="pixels across")] = 1600,
) -> Figure:
    """All 2^n embeddings of the target over the source, with their distances, the least one ringed (figure 6.2)."""
    from matplotlib.patches import Ellipse

    count = min(n, distance.source_points.shape[1])
    source = distance.source_points[:, :count]
    target = (distance.target_points @ distance.basis.T)[:, :count]
    first, second = (s.mesh.vertex_areas / s.mesh.area for s in (source_surface, target_surface))
    choices = list(product((1.0, -1.0), repeat=count))
    values = []
    for signs in choices:
        forward, backward = mutual_distances(source, target * signs)
        values.append(max(float(forward @ first), float(backward @ second)))
    best = int(np.argmin(values))
    columns = 4
    rows = -(-len(choices) // columns)
    rng = np.random.default_rng(0)
    some = [rng.permutation(len(cloud))[:dots] for cloud in (source, target)]
    em = 0.0125 * width
    with canvas(width, round(width * (0.235 * rows))) as figure:
        for k, (signs, value) in enumerate(zip(choices, values, strict=True)):
            axes = figure.add_subplot(rows, columns, k + 1, projection="3d" if count > 2 else None)
            for cloud, picked, color in ((source, some[0], "#6e6e6e"), (target * signs, some[1], COLORS[0])):
                axes.scatter(*cloud[picked, :3].T, s=6.0, c=color, linewidths=0, alpha=0.8)
            if count > 2:
                axes.view_init(18, -55)
                axes.set_box_aspect(np.ptp(source[:, :3], axis=0), zoom=1.38)
            axes.set_axis_off()
            mark = "(" + " ".join("+" if sign > 0 else "−" for sign in signs) + ")"
            is_best = k == best
            axes.set_position(((k % columns) / columns, 1.0 - (k // columns + 1) / rows, 1.0 / columns, 0.9 / rows))
            figure.text(
                (k % columns + 0.5) / columns,
                1.0 - (k // columns + 0.06) / rows,
                f"{mark}  {value:.4f}" + ("  least" if is_best else ""),
                fontsize=points(1.15 * em),
                fontweight="bold" if is_best else "normal",
                color=COLORS[1] if is_best else "#222222",
                ha="center",
                va="center",
            )
        figure.add_artist(
            Ellipse(
                ((best % columns + 0.5) / columns, 1.0 - (best // columns + 0.56) / rows),
                0.95 / columns,
                0.84 / rows,
                fill=False,
                edgecolor=COLORS[1],
                linewidth=points(0.14 * em),
            )
        )
        pixels = drawn(figure)
    least, following = (float(value) for value in np.sort(values)[:2])
    times = f", the next best is {following / least:.2f} times as far" if least > 1e-12 * following else ""
    caption = (
        f"{target_surface.name} (blue) over {source_surface.name} (grey) in the first {count} eigenfunctions: "
        f"all {2**count} choices of signs with their mean Hausdorff distances; "
        f"the ringed one is the optimal embedding{times}.{compare(reference)}"
    )
    return Figure(pixels, caption, f"{2**count} embeddings", {"least": least, "next": following})
