"""Figures 5.1, 5.8 and 5.9: the skeletons of a group."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.drawings.skeleton_drawing import SkeletonView, skeleton_panel
from surfexp.figures.figure import Figure
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.hamilton_jacobi import hamilton_jacobi_skeleton
from surfexp.studies.skeletons.skeleton_study import group_skeletons


@register("figure", "skeleton_group", defaults_of=group_skeletons)
def skeleton_group_figure(
    surfaces: dict[str, Surface],
    *,
    method: Annotated[Literal["reeb_graph", "hamilton_jacobi"], Field(description="which skeleton")] = "reeb_graph",
    alpha: Annotated[
        float, Field(ge=0, le=10, description="exponent of the flux weights (5.10); at 0 the weight is 1")
    ],
    levels: Annotated[Literal["uniform", "area_quantile", "arc_length"], Field(description="where the levels lie")],
    count: Annotated[int, Field(ge=5, le=1000, description="number of levels")],
    threshold: Annotated[
        float, Field(lt=0, ge=-1, description="flux below which a Hamilton-Jacobi skeleton keeps an end")
    ] = -0.35,
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -90.0,
    elevation: Annotated[
        float, Field(ge=-90, le=90, description="height of view, degrees; 90 looks down on x, y")
    ] = 90.0,
    columns: Annotated[int, Field(ge=1, le=12, description="surfaces side by side")] = 4,
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1500,
    titles: Annotated[bool, Field(description="write the axis label above each surface")] = False,
) -> Figure:
    """The skeletons of all members of a group over their surfaces, at one scale."""
    if method == "reeb_graph":
        skeletons = group_skeletons(surfaces, alpha, 1.0, levels, count)
        weight = "isotropic" if not alpha else f"flux-weighted (alpha {alpha:g})"
        chosen_method = f"Reeb graphs of the {weight} eigenmap at {count} {levels.replace('_', ' ')} levels"
    else:
        skeletons = {
            name: hamilton_jacobi_skeleton(item.mesh, boundary_distance(item.mesh), threshold, item.name)
            for name, item in surfaces.items()
        }
        chosen_method = "Hamilton-Jacobi skeletons"
    headings = {name: name if titles else "" for name in surfaces}
    views = [SkeletonView(surfaces[name].mesh, found, title=headings[name]) for name, found in skeletons.items()]
    chains = sum(found.is_chain for found in skeletons.values())
    caption = f"{chosen_method}: {chains} of {len(views)} are chains. Green dots are ends, orange ones junctions."
    view = (azimuth, elevation)
    return skeleton_panel(views, view=view, columns=min(columns, len(views)), width=width, caption=caption)
