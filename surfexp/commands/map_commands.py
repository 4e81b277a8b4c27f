"""Commands that clean maps of one's own: surface and map in, map out, certificate beside it."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, Literal

import click

from surfexp.commands.click_command import shown
from surfexp.commands.surface_arguments import (
    finish,
    given_maps,
    named_as,
    opened,
    progress_line,
    proof_option,
    ready_map,
    ready_proof,
    result_option,
    save_proof,
    surface_options,
)

EXAMPLES = {
    "denoise": ("lh.white lh.thickness --to clean.shape.gii", "scan.ply quality --to clean.ply"),
    "smooth": ("lh.white lh.thickness --width 6 --to smooth.mgh", "a.surf.gii a.func.gii --width 4mm --to b.func.gii"),
}


@click.command(**shown("denoise", *EXAMPLES["denoise"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="MAP", type=click.Path())
@click.option(
    "--method",
    type=click.Choice(["auto", "rof", "tgv"]),
    default="auto",
    help="auto: the filters with the smallest estimated error; rof: total variation; "
    "tgv: total generalised variation, which avoids staircasing",
)
@click.option("--weight", type=float, help="of rof and tgv: dimensionless, smaller is smoother; 0.9 if not given")
@click.option("--ratio", type=float, help="of tgv: over how many edge lengths a slope may change; 2 if not given")
@click.option("--noise", type=float, help="standard deviation of the noise; estimated if not given")
@click.option("--tolerance", type=float, help="largest relative duality gap; 1e-3 for auto, else 1e-4")
@surface_options
@proof_option
@result_option()
def denoise(
    path: str,
    map_name: str,
    method: Literal["auto", "rof", "tgv"],
    weight: float | None,
    ratio: float | None,
    noise: float | None,
    tolerance: float | None,
    target: Path,
    proof: Path | None,
    **given: Any,
) -> int:
    """Remove the noise of a map by the filters that promise the least error.

    --method chooses one of them, with a proved gap.

    MAP is a file, or a map that the surface carries.
    """
    from surfexp.io.map_files import side_by_side
    from surfexp.tasks.denoising import denoise as task

    surface, files = opened(path, **given)
    maps = given_maps(surface, map_name, files, given["hemisphere"])
    values = side_by_side(maps, map_name)
    channels = 1 if values.ndim == 1 else values.shape[1]
    ready_map(target, files, surface, values, channels=channels)
    ready_proof(proof, files)
    if proof is not None and method == "auto":
        raise ValueError("--proof with method auto, which proves no gap: choose method rof or tgv")
    started = time.perf_counter()
    with progress_line("denoise") as progress:
        options: dict[str, Any] = {"method": method, "weight": weight, "ratio": ratio, "tolerance": tolerance}
        clean = task(surface, values, noise=noise, progress=progress, **options)
    facts = clean.certificate | {"seconds": time.perf_counter() - started}
    save_proof(proof, clean)
    chosen = {name: value for name, value in options.items() if name != "method" and value is not None}
    return finish(target, named_as(maps, clean.values, target), surface, method, chosen, files, facts, clean.notes)


def millimetres(text: str) -> float:
    """The number of a width such as 6 or 6mm."""
    try:
        return float(text.removesuffix("mm"))
    except ValueError:
        raise click.BadParameter(f"{text!r} is no width: write 6 or 6mm") from None


@click.command(**shown("smooth", *EXAMPLES["smooth"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="MAP", type=click.Path())
@click.option(
    "--width", type=millimetres, required=True, help="full width at half maximum, in the unit of the surface: 6mm"
)
@surface_options
@result_option()
def smooth(path: str, map_name: str, width: float, target: Path, **given: Any) -> int:
    """Smooth a map by heat flow, as a Gaussian of a given width would.

    MAP is a file, or a map that the surface carries.
    """
    from surfexp.io.map_files import side_by_side
    from surfexp.tasks.denoising import smooth as task

    surface, files = opened(path, **given)
    maps = given_maps(surface, map_name, files, given["hemisphere"])
    values = side_by_side(maps, map_name)
    channels = 1 if values.ndim == 1 else values.shape[1]
    ready_map(target, files, surface, values, channels=channels)
    started = time.perf_counter()
    smoothed = task(surface, values, width)
    facts = smoothed.certificate | {"seconds": time.perf_counter() - started}
    return finish(
        target, named_as(maps, smoothed.values, target), surface, "heat", {"width": width}, files, facts, smoothed.notes
    )
