"""Figures 5.2 to 5.5: level sets and skeleton on the surface."""

from pydantic import Field

from surfexp.drawings.skeleton_drawing import SkeletonView, skeleton_panel
from surfexp.figures.figure import Figure, sentence
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.skeleton import Skeleton


class ReebGraphPicture(Options):
    """How it is drawn."""

    azimuth: float = Field(-90.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(90.0, ge=-90, le=90, description="height of view, degrees; 90 looks down on x, y")
    width: int = Field(1300, ge=200, le=8000, description="pixels across")
    caption: str = Field("", description="sentence below the figure; default: the counts of the graph")


@register("figure", "reeb_graph")
def reeb_graph_figure(options: ReebGraphPicture, *, surface: Surface, feature: Feature, skeleton: Skeleton) -> Figure:
    """Feature with its level sets, and the Reeb graph over the surface."""
    views = [
        SkeletonView(surface.mesh, None, feature.values, title=feature.name),
        SkeletonView(surface.mesh, skeleton, None, feature.values, title="level sets and Reeb graph"),
    ]
    counts = {name: int(skeleton.metrics[name]) for name in ("contours", "b1", "leaves", "branch_nodes")}
    caption = options.caption or (
        f"{sentence(surface.name)}, {feature.name}: {counts['contours']} contours at {len(skeleton.levels)} levels, "
        f"{counts['b1']} loops, {counts['leaves']} leaves (green), {counts['branch_nodes']} branch nodes (orange)."
    )
    title = f"{surface.name} · {feature.name}"
    view = (options.azimuth, options.elevation)
    return skeleton_panel(views, view=view, width=options.width, title=title, caption=caption)
