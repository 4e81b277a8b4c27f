"""What an implicit method needs before it starts, tables 2.1 and 2.2."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.baselines.level_set import level_set
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic

METRICS = {
    "band_nodes": Metric("nodes of the narrow band"),
    "nodes_per_vertex": Metric("nodes for each vertex"),
    "memory_bytes": Metric("memory of the band and what extends data to it", "bytes"),
}


@register("statistic", "narrow_band", metrics=METRICS)
def narrow_band_statistic(
    surface: Surface,
    *,
    points: Annotated[
        int, Field(ge=16, le=2048, description="grid points along the longest side of the surface")
    ] = 162,
) -> Statistic:
    """Nodes of the narrow band of a grid around a surface with what extends data to it: the level set method's set-up."""
    spacing = float(np.ptp(surface.mesh.vertices, axis=0).max()) / points
    method = level_set(surface.mesh, spacing, 3)
    nodes, vertices = method.energy.band.node_count, len(surface.mesh.vertices)
    metrics = {"band_nodes": float(nodes), "nodes_per_vertex": nodes / vertices, "memory_bytes": float(method.memory)}
    return Statistic(f"narrow band of the {surface.name}", metrics=metrics)
