"""`surfexp segment`: two regions of a surface as a file of labels."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click

from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import map_of
from surfexp.commands.given_surfaces import opened
from surfexp.commands.surface_options import result_option, surface_options
from surfexp.commands.surface_results import finish, ready_map
from surfexp.commands.terminal import progress_line


@click.command(**shown("segment", "lh.white --to parts.label.gii", "scan.ply height.csv --smoothness 1 --to parts.vtk"))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="[MAP]", required=False, type=click.Path())
@click.option("--smoothness", type=float, help="dimensionless, larger is smoother; read from the noise if not given")
@click.option("--tolerance", default=1e-3, help="largest relative duality gap of the relaxed problem")
@click.option("--threads", type=int, help="all cores if not given, the bytes are the same")
@surface_options
@result_option()
def segment(
    path: str,
    map_name: str | None,
    smoothness: float | None,
    tolerance: float,
    threads: int | None,
    target: Path,
    **given: Any,
) -> int:
    """Divide a surface into two regions, with a proved lower bound.

    They are where MAP is larger and where it is smaller. Without MAP it is the mean curvature, clipped at the median of
    its size: gyri and sulci of a cortex.
    """
    from surfexp.tasks.segmentation import segment as task

    surface, files = opened(path, **given)
    values = map_of(surface, map_name, files, given["hemisphere"]) if map_name else None
    ready_map(target, files, surface, *([] if values is None else [values]), labels=True)
    started = time.perf_counter()
    with progress_line("segment") as progress:
        parts = task(surface, values, smoothness=smoothness, tolerance=tolerance, threads=threads, progress=progress)
    names = ("c1", "c2", "energy", "lower_bound", "gap", "labelling_gap", "converged", "perimeter")
    facts = {name: getattr(parts, name) for name in names} | {"seconds": time.perf_counter() - started}
    options: dict[str, Any] = {} if smoothness is None else {"smoothness": smoothness}
    options |= {"tolerance": tolerance, "map": map_name or "mean curvature"}
    return finish(target, parts, surface, "convex Chan-Vese", options, files, facts, parts.notes)
