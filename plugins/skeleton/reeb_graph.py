"""The Reeb graph as a skeleton."""

from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.pruning import pruned
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import Skeleton
from surfexp.skeleton.skeleton_length import skeleton_lengths

METRICS = {
    "levels": Metric("number of levels"),
    "contours": Metric("number of contours"),
    "hidden_handles": Metric("handles without a level between their saddles", better="lower"),
    "cut_branches": Metric("branches that the simplification cut off"),
    "edge_length": Metric("mean length of the edges", "unit of length"),
    "polyline_length": Metric("length of the line through the contours", "unit of length"),
    "length_with_extrema": Metric("length of that line with the extremal vertices", "unit of length"),
    "geodesic_length": Metric("geodesic distance of the extremal vertices", "unit of length"),
    "mean_distance_length": Metric("sum of the mean distances between levels", "unit of length"),
}


@register("skeleton", "reeb_graph", metrics=METRICS)
def reeb_graph_skeleton(
    surface: Surface,
    feature: Feature,
    *,
    count: Annotated[int, Field(ge=1, le=5000, description="number of levels")] = 50,
    levels: Annotated[
        Literal["uniform", "area_quantile", "arc_length", "critical"],
        Field(
            description="where they lie: uniform as published, or evenly in area, in distance, between critical values"
        ),
    ] = "arc_length",
    persistence: Annotated[
        float, Field(ge=0, le=0.5, description="branches below this share of the range are cut off")
    ] = 0.0,
) -> Skeleton:
    """Reeb graph of a feature at sampled levels (section 5.2), with caps and junctions, and lengths of its trunk."""
    chosen_levels = choose_levels(surface.mesh, feature.values, count, levels)
    skeleton = pruned(reeb_graph(surface.mesh, feature.values, chosen_levels, surface.name), persistence)
    metrics = {"edge_length": surface.mesh.edge_length}
    if skeleton.metrics["components"] == 1:
        metrics |= skeleton_lengths(surface.mesh, feature.values, skeleton)
    notes = skeleton.notes
    if len(chosen_levels) < count:
        notes += (f"The feature is flat in places: {len(chosen_levels)} of {count} levels differ.",)
    return replace(skeleton, metrics={**skeleton.metrics, **metrics}, notes=notes)
