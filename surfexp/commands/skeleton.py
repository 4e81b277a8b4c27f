"""`surfexp skeleton`: the Reeb graph of a map, and what every command on Reeb graphs is asked."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import map_of
from surfexp.commands.given_surfaces import opened
from surfexp.commands.surface_options import result_option, surface_options
from surfexp.commands.surface_results import finish, ready
from surfexp.commands.table_file import ready_table

LEVELS = ("arc_length", "uniform", "area_quantile", "critical")
EXAMPLES = ("vessel.ply --to skeleton.swc", "patch.ply height.csv --branches table.csv --to skeleton.graphml")


def level_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options of a Reeb graph: how many levels, where they lie, and which branches are too short."""
    options: list[Callable[..., Any]] = [
        click.option("--count", default=50, help="number of level sets"),
        click.option(
            "--levels",
            type=click.Choice(LEVELS),
            default=LEVELS[0],
            help="where they lie; critical: one between any two critical values, so that no loop is missed",
        ),
        click.option("--persistence", default=0.0, help="branches shorter than this share of the range are removed"),
    ]
    for option in reversed(options):
        command = option(command)
    return command


@click.command(**shown("skeleton", *EXAMPLES))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="[MAP]", required=False, type=click.Path())
@level_options
@click.option("--branches", type=click.Path(path_type=Path), metavar="FILE", help="lengths and radii of branches, .csv")
@surface_options
@result_option()
def skeleton(
    path: str,
    map_name: str | None,
    count: int,
    levels: Any,
    persistence: float,
    branches: Path | None,
    target: Path,
    **given: Any,
) -> int:
    """Find the Reeb graph of a map on a surface.

    Without MAP it is that of the first eigenfunction. The result is .graphml, .swc where it is a tree, .vtk or .ply.
    """
    from surfexp.skeleton.export import check_skeleton_target
    from surfexp.tasks.skeletons import first_eigenfunction, reeb_graph

    surface, files = opened(path, **given)
    given_map = map_of(surface, map_name, files, given["hemisphere"]) if map_name else None
    ready(target, files, check_skeleton_target)
    ready_table(branches, files, "--branches")
    started = time.perf_counter()
    values, said = first_eigenfunction(surface) if given_map is None else (given_map, ())
    graph = reeb_graph(surface, values, count=count, levels=levels, persistence=persistence)
    facts = {
        "nodes": len(graph.positions),
        "arcs": len(graph.arcs),
        "loops": int(graph.metrics["b1"]),
        "hidden_loops": int(graph.metrics["hidden_handles"]),
        "seconds": time.perf_counter() - started,
    }
    options = {
        "count": count,
        "levels": levels,
        "persistence": persistence,
        "map": map_name or "first eigenfunction",
    }
    notes = tuple(dict.fromkeys((*said, *graph.notes)))
    code = finish(target, graph, surface, "reeb graph", options, files, facts, notes)
    if branches is not None:
        from surfexp.io.csv_cells import write_columns

        write_columns(branches, graph.branches())
    return code
