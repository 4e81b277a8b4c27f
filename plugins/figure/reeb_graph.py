"""Figures 5.2 to 5.5: level sets and skeleton on the surface."""

from typing import Annotated

from pydantic import Field

from surfexp.drawings.skeleton_drawing import SkeletonView, skeleton_panel
from surfexp.figures.figure import Figure, sentence
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.skeleton import Skeleton


@register("figure", "reeb_graph", defaults_of=skeleton_panel)
def reeb_graph_figure(
    surface: Surface,
    feature: Feature,
    skeleton: Skeleton,
    *,
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -90.0,
    elevation: Annotated[
        float, Field(ge=-90, le=90, description="height of view, degrees; 90 looks down on x, y")
    ] = 90.0,
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1300,
    caption: Annotated[str, Field(description="sentence below the figure; default: the counts of the graph")],
) -> Figure:
    """Feature with its level sets, and the Reeb graph over the surface."""
    views = [
        SkeletonView(surface.mesh, None, feature.values, title=feature.name),
        SkeletonView(surface.mesh, skeleton, None, feature.values, title="level sets and Reeb graph"),
    ]
    counts = {name: int(skeleton.metrics[name]) for name in ("contours", "b1", "leaves", "branch_nodes")}
    caption = caption or (
        f"{sentence(surface.name)}, {feature.name}: {counts['contours']} contours at {len(skeleton.levels)} levels, "
        f"{counts['b1']} loops, {counts['leaves']} leaves (green), {counts['branch_nodes']} branch nodes (orange)."
    )
    title = f"{surface.name} · {feature.name}"
    view = (azimuth, elevation)
    return skeleton_panel(views, view=view, width=width, title=title, caption=caption)
