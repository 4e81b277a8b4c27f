"""Figures 5.6 and 5.7: weights, and level sets with the skeleton, along an axis."""

from typing import Annotated

from pydantic import Field

from surfexp.drawings.skeleton_drawing import SkeletonView, skeleton_panel
from surfexp.figures.figure import Figure
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.skeleton import Skeleton


@register("figure", "level_sets", defaults_of=skeleton_panel)
def level_sets_figure(
    surface: Surface,
    weights: dict[str, Feature],
    features: dict[str, Feature],
    skeletons: dict[str, Skeleton],
    *,
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -90.0,
    elevation: Annotated[
        float, Field(ge=-90, le=90, description="height of view, degrees; 90 looks down on x, y")
    ] = 90.0,
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1600,
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Weights above, level sets and Reeb graphs of their eigenmaps below, side by side along an axis."""
    above = [SkeletonView(surface.mesh, None, weight.values, title=name) for name, weight in weights.items()]
    below = [SkeletonView(surface.mesh, skeleton, None, features[name].values) for name, skeleton in skeletons.items()]
    view = (azimuth, elevation)
    return skeleton_panel([*above, *below], view=view, columns=len(above), width=width, caption=caption)
