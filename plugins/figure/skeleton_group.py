"""Figures 5.1, 5.8 and 5.9: the skeletons of a group."""

from typing import Literal

from pydantic import Field

from surfexp.drawings.skeleton_drawing import SkeletonView, skeleton_panel
from surfexp.figures.figure import Figure
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.hamilton_jacobi import hamilton_jacobi_skeleton
from surfexp.studies.skeletons.skeleton_study import group_skeletons


class SkeletonGroup(Options):
    """Which skeletons, and how they are drawn."""

    method: Literal["reeb_graph", "hamilton_jacobi"] = Field("reeb_graph", description="which skeleton")
    alpha: float = Field(0.0, ge=0, le=10, description="exponent of the flux weights (5.10); at 0 the weight is 1")
    levels: Literal["uniform", "area_quantile", "arc_length"] = Field("arc_length", description="where the levels lie")
    count: int = Field(50, ge=5, le=1000, description="number of levels")
    threshold: float = Field(-0.35, lt=0, ge=-1, description="flux below which a Hamilton-Jacobi skeleton keeps an end")
    azimuth: float = Field(-90.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(90.0, ge=-90, le=90, description="height of view, degrees; 90 looks down on x, y")
    columns: int = Field(4, ge=1, le=12, description="surfaces side by side")
    width: int = Field(1500, ge=200, le=8000, description="pixels across")
    titles: bool = Field(False, description="write the axis label above each surface")


@register("figure", "skeleton_group")
def skeleton_group_figure(options: SkeletonGroup, *, surfaces: dict[str, Surface]) -> Figure:
    """The skeletons of all members of a group over their surfaces, at one scale."""
    if options.method == "reeb_graph":
        skeletons = group_skeletons(surfaces, options.alpha, 1.0, options.levels, options.count)
        weight = "isotropic" if not options.alpha else f"flux-weighted (alpha {options.alpha:g})"
        method = f"Reeb graphs of the {weight} eigenmap at {options.count} {options.levels.replace('_', ' ')} levels"
    else:
        skeletons = {
            name: hamilton_jacobi_skeleton(item.mesh, boundary_distance(item.mesh), options.threshold, item.name)
            for name, item in surfaces.items()
        }
        method = "Hamilton-Jacobi skeletons"
    titles = {name: name if options.titles else "" for name in surfaces}
    views = [SkeletonView(surfaces[name].mesh, found, title=titles[name]) for name, found in skeletons.items()]
    chains = sum(found.is_chain for found in skeletons.values())
    caption = f"{method}: {chains} of {len(views)} are chains. Green dots are ends, orange ones junctions."
    view = (options.azimuth, options.elevation)
    return skeleton_panel(
        views, view=view, columns=min(options.columns, len(views)), width=options.width, caption=caption
    )
