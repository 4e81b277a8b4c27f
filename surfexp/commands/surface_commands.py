"""Commands that work on surfaces of one's own: file in, file out, certificate beside it."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click

from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import label_of_bar, shown_borders, shown_map
from surfexp.commands.given_surfaces import opened
from surfexp.commands.proof_pages import ready_proof_of, save_proof
from surfexp.commands.surface_options import picture_options, proof_option, result_option, surface_options
from surfexp.commands.surface_results import files_made, finish, ready, ready_map
from surfexp.commands.terminal import echo, progress_line

EXAMPLES = {
    "modes": ("lh.white --to modes.npz", "brain.gii -k 200 --mask lh.cortex.label --to modes.vtk"),
    "geodesic": ("lh.white 0 --to distance.shape.gii", "bunny.ply 12 40 --to distance.csv"),
    "curvature": ("lh.white --to curvature.shape.gii", "bunny.ply --to bunny.vtp"),
    "convert": ("lh.white white.gii", "scan.obj scan.ply"),
    "plot": (
        "lh.white lh.thickness --to thickness.pdf",
        "lh.white lh.thickness --views lateral --colormap magma --limits 1 4 --to thickness.png",
    ),
}


@click.command(**shown("modes", *EXAMPLES["modes"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.option("-k", "count", default=50, help="number of eigenpairs")
@click.option("--tolerance", default=1e-8, help="largest relative residual")
@click.option(
    "--threads", type=int, help="threads for more than 200 pairs; all cores by default, the bytes are the same"
)
@surface_options
@proof_option
@result_option()
def modes(
    path: str, count: int, tolerance: float, threads: int | None, target: Path, proof: Path | None, **given: Any
) -> int:
    """Find the lowest Laplace-Beltrami eigenpairs, with the proof that none is missing."""
    from surfexp.tasks.spectra import eigenpairs

    surface, files = opened(path, **given)
    ready_map(target, files, surface, count=count)
    ready_proof_of(proof, files, surface, columns=count)
    started = time.perf_counter()
    with progress_line("modes") as progress:
        system = eigenpairs(surface, count, tolerance=tolerance, progress=progress, threads=threads)
    facts = {
        "complete": system.complete,
        "residual": float(system.residuals.max()),
        "seconds": time.perf_counter() - started,
    }
    chosen = {"k": count, "tolerance": tolerance}
    code = finish(target, system, surface, "eigenpairs", chosen, files, facts, system.notes)
    save_proof(proof, system, surface)
    return code


@click.command(**shown("geodesic", *EXAMPLES["geodesic"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("sources", metavar="VERTEX...", nargs=-1, type=int, required=True)
@surface_options
@result_option()
def geodesic(path: str, sources: tuple[int, ...], target: Path, **given: Any) -> None:
    """Measure the geodesic distance from vertices, with a bound from below."""
    import numpy as np

    from surfexp.tasks.skeletons import geodesic as task
    from surfexp.tasks.skeletons import where_reached

    surface, files = opened(path, **given)
    ready_map(target, files, surface, where_reached(surface, sources))
    started = time.perf_counter()
    with progress_line("geodesic") as progress:
        values, lower = task(surface, sources, bounds=True, progress=progress)
    unreached = np.isinf(values)
    within = float(np.nanmax(np.where(unreached, 0.0, values - np.where(unreached, 0.0, lower))))
    facts = {"too_long_by_at_most": within, "seconds": time.perf_counter() - started}
    notes = (f"{unreached.sum()} vertices are joined to no source: they are NaN.",) if unreached.any() else ()
    distance = {"distance": np.where(unreached, np.nan, values)}
    finish(target, distance, surface, "straightened fronts", {"sources": list(sources)}, files, facts, notes)


@click.command(**shown("curvature", *EXAMPLES["curvature"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@surface_options
@result_option()
def curvature(path: str, target: Path, **given: Any) -> None:
    """Compute the mean curvature, positive where the surface bulges outward."""
    from surfexp.tasks.skeletons import mean_curvature

    surface, files = opened(path, **given)
    ready_map(target, files, surface)
    started = time.perf_counter()
    values = mean_curvature(surface)
    facts = {"seconds": time.perf_counter() - started}
    finish(target, {"mean curvature": values}, surface, "mean curvature", {}, files, facts)


@click.command(**shown("convert", *EXAMPLES["convert"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("result", metavar="[TARGET]", required=False, type=click.Path(path_type=Path))
@surface_options
@result_option(required=False)
def convert(path: str, result: Path | None, target: Path | None, **given: Any) -> None:
    """Write a surface in another format, with its maps.

    The suffix of TARGET, or of --to, decides; what its format has no room for is named.
    """
    targets = [one for one in (result, target) if one is not None]
    if len(targets) != 1:
        raise click.UsageError(f"{len(targets)} targets are given, one is needed: surfexp convert SURFACE TARGET")
    from surfexp.tasks.written_files import written
    from surfexp.tasks.written_targets import check_surface_target

    surface, files = opened(path, **given)
    ready(targets[0], files, check_surface_target, hemisphere=surface.hemisphere)
    notes = written(targets[0], surface)
    echo(f"{files_made(targets[0], surface)}: {len(surface.mesh.vertices)} vertices, {len(surface.mesh.faces)} faces")
    for note in notes:
        echo(note)


@click.command(**shown("plot", *EXAMPLES["plot"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="[MAP]", required=False, type=click.Path())
@click.option("--width", default=1600, help="width of the picture in pixels")
@picture_options
@surface_options
@result_option()
def plot(
    path: str,
    map_name: str | None,
    width: int,
    target: Path,
    looks: dict[str, Any],
    **given: Any,
) -> None:
    """Draw a surface, coloured by a map or by labels.

    The picture is .png, or a drawing: .svg, .pdf.
    """
    from surfexp.tasks.pictures import check_picture_target
    from surfexp.tasks.pictures import plot as task

    surface, files = opened(path, **given)
    values = shown_map(surface, map_name, files, given["hemisphere"])
    looks["label"] = looks["label"] or label_of_bar(values, map_name)
    looks["borders"] = shown_borders(surface, looks["borders"], files, given["hemisphere"])
    ready(target, files, check_picture_target)
    task(surface, values, width=width, **looks).save(target)
    echo(str(target))
