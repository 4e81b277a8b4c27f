"""Loops of Reeb graphs against handles of surfaces."""

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.hidden_handles import hidden_handles
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.published_reeb_graph import published_loops
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import arc_components
from surfexp.statistics.statistic import Statistic

METRICS = {
    "handles": Metric("handles of the surface"),
    "right": Metric("share of runs with as many loops as handles", better="higher"),
    "right_or_said": Metric("share of runs right with the hidden handles that are reported", better="higher"),
    "wrong": Metric("runs with another number of loops", better="lower"),
    "hidden_extent": Metric("largest extent of a hidden handle, share of the range"),
    "right_at_finest": Metric("share of runs right at most levels", better="higher"),
    "exact_right": Metric("share right with critical levels", better="higher"),
    "published_right": Metric("share right by the published rule", better="higher"),
    "too_many": Metric("runs with more loops than handles", better="lower"),
    "runs": Metric("number of runs"),
}


@register("statistic", "genus_check", metrics=METRICS)
def genus_check_statistic(
    surface: Surface,
    *,
    directions: Annotated[int, Field(ge=1, le=1000, description="random directions of height")] = 8,
    counts: Annotated[Sequence[int], Field(min_length=1, description="numbers of levels")] = [10, 20, 50, 100, 200],
    levels: Annotated[
        Literal["uniform", "area_quantile", "arc_length", "critical"],
        Field(description="where the levels lie; critical ones separate all saddles"),
    ] = "uniform",
    seed: Annotated[int, Field(ge=0, description="seed of the directions")] = 0,
) -> Statistic:
    """Loops of the Reeb graphs of heights in random directions, sampled and exact, against the genus of a closed surface."""
    mesh = surface.mesh
    if not mesh.is_closed:
        raise ValueError(f"{surface.name} has a boundary, the number of loops is the genus on closed surfaces only")
    sampled = np.random.default_rng(seed).normal(size=(directions, 3))
    rows = []
    for number, direction in enumerate(sampled):
        height = mesh.vertices @ (direction / np.linalg.norm(direction))
        exact = exact_reeb_graph(mesh, height)
        loops = len(exact.arcs) - len(exact.vertices) + arc_components(exact.arcs, len(exact.vertices))
        for count in counts:
            chosen_levels = choose_levels(mesh, height, count, levels)
            found, hidden = (
                reeb_graph(mesh, height, chosen_levels).metrics["b1"],
                hidden_handles(mesh, height, chosen_levels),
            )
            said = sum(item.handles for item in hidden)
            largest = max((item.high - item.low for item in hidden), default=0.0) / float(np.ptp(height))
            rows.append((number, count, found, said, largest, loops, published_loops(mesh, height, chosen_levels)))
    columns = dict(
        zip(
            ("direction", "levels", "loops", "said", "hidden_extent", "exact_loops", "published_loops"),
            np.array(rows, float).T,
            strict=True,
        )
    )
    right = columns["loops"] == mesh.genus
    finest = columns["levels"] == max(counts)
    metrics = {
        "handles": float(mesh.genus),
        "right": float(right.mean()),
        "right_or_said": float((columns["loops"] + columns["said"] == mesh.genus).mean()),
        "wrong": float((~right).sum()),
        "hidden_extent": float(columns["hidden_extent"].max()),
        "right_at_finest": float(right[finest].mean()),
        "exact_right": float((columns["exact_loops"] == mesh.genus).mean()),
        "published_right": float((columns["published_loops"] == mesh.genus).mean()),
        "too_many": float((columns["loops"] > mesh.genus).sum()),
        "runs": float(len(rows)),
    }
    return Statistic("loops against handles", columns, metrics=metrics)
