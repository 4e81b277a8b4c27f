"""Commands that clean maps of one's own: surface and map in, map out, certificate beside it."""

from __future__ import annotations

import time
from pathlib import Path
from string import ascii_lowercase
from typing import TYPE_CHECKING, Any, Literal

import click

from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import given_maps, map_of
from surfexp.commands.given_surfaces import opened
from surfexp.commands.proof_pages import ready_proof_of, save_proof
from surfexp.commands.surface_options import proof_option, result_option, surface_options
from surfexp.commands.surface_results import finish, named_as, ready_map
from surfexp.commands.terminal import progress_line

if TYPE_CHECKING:
    from surfexp.mesh.surface import Surface

METRES = {"nm": 1e-9, "um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0}
# both characters for it
MICRO = str.maketrans("µμ", "uu")
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
@click.option(
    "--second", "second_name", type=click.Path(), help="another measurement of the map, by which its noise is known"
)
@click.option("--tolerance", type=float, help="largest relative duality gap; 1e-3 for auto, else 1e-4")
@click.option("--threads", type=int, help="of auto; all cores if not given, the bytes are the same")
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
    second_name: str | None,
    tolerance: float | None,
    threads: int | None,
    target: Path,
    proof: Path | None,
    **given: Any,
) -> int:
    """Remove the noise of a map by the filters that promise the least error.

    --method chooses one of them, with a proved gap.

    MAP is a file, or a map that the surface carries.
    """
    from surfexp.io.map_files import side_by_side
    from surfexp.io.written_maps import check_names
    from surfexp.tasks.denoising import denoise as task
    from surfexp.tasks.noise_of_map import noise as noise_task

    surface, files = opened(path, **given)
    maps = given_maps(surface, map_name, files, given["hemisphere"])
    values = side_by_side(maps, map_name)
    channels = 1 if values.ndim == 1 else values.shape[1]
    ready_map(target, files, surface, values, channels=channels)
    check_names(target, maps)
    # the map before and after, and a vector in each face; of tgv more
    ready_proof_of(proof, files, surface, values, columns=2 * channels, of_faces=2 * channels)
    if proof is not None and method == "auto":
        raise ValueError("--proof with method auto, which proves no gap: choose method rof or tgv")
    if noise is not None and second_name:
        raise ValueError("--noise and --second both say what the noise is: give one of them")
    second = map_of(surface, second_name, files, given["hemisphere"]) if second_name else None
    started = time.perf_counter()
    known = noise if second is None else noise_task(surface, values, second)
    with progress_line("denoise") as progress:
        options: dict[str, Any] = {"method": method, "weight": weight, "ratio": ratio, "tolerance": tolerance}
        clean = task(surface, values, noise=known, threads=threads, progress=progress, **options)
    facts = clean.certificate | {"seconds": time.perf_counter() - started}
    chosen = {name: value for name, value in options.items() if name != "method" and value is not None}
    code = finish(target, named_as(maps, clean.values, target), surface, method, chosen, files, facts, clean.notes)
    save_proof(proof, clean)
    return code


def width_and_unit(text: str) -> tuple[float, str]:
    """The number and the unit of a width such as 6, 6mm, 0.6cm or 40µm."""
    given = text.strip().translate(MICRO)
    number = given.rstrip(ascii_lowercase)
    unit = given[len(number) :]
    try:
        if unit in ("", *METRES):
            return float(number), unit
    except ValueError:
        pass
    raise click.BadParameter(f"{text!r} is no width: write 6 or 6mm ({', '.join(METRES)})")


def in_unit_of(surface: Surface, width: float, unit: str) -> float:
    """Return a width in the unit of a surface.

    Raises
    ------
    ValueError
        If the width has a unit, and that of the surface is not known or no length.
    """
    own = surface.unit.translate(MICRO)
    if unit in ("", own):
        return width
    if own not in METRES:
        known = f"the surface in {surface.unit!r}" if surface.unit else "the unit of the surface is not known"
        raise ValueError(
            f"--width {width:g}{unit} is in {unit}, {known}: give --unit {', '.join(METRES)}, or a number alone"
        )
    return width * METRES[unit] / METRES[own]


@click.command(**shown("smooth", *EXAMPLES["smooth"]))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="MAP", type=click.Path())
@click.option(
    "--width",
    type=width_and_unit,
    metavar="LENGTH",
    required=True,
    help="full width at half maximum: 6 in the unit of the surface, or 6mm",
)
@surface_options
@result_option()
def smooth(path: str, map_name: str, width: tuple[float, str], target: Path, **given: Any) -> int:
    """Smooth a map by heat flow, as a Gaussian of a given width would.

    MAP is a file, or a map that the surface carries.
    """
    from surfexp.io.map_files import side_by_side
    from surfexp.io.written_maps import check_names
    from surfexp.tasks.denoising import smooth as task

    surface, files = opened(path, **given)
    maps = given_maps(surface, map_name, files, given["hemisphere"])
    values = side_by_side(maps, map_name)
    channels = 1 if values.ndim == 1 else values.shape[1]
    ready_map(target, files, surface, values, channels=channels)
    check_names(target, maps)
    full_width = in_unit_of(surface, *width)
    started = time.perf_counter()
    smoothed = task(surface, values, full_width)
    facts = smoothed.certificate | {"seconds": time.perf_counter() - started}
    return finish(
        target,
        named_as(maps, smoothed.values, target),
        surface,
        "heat",
        {"width": full_width},
        files,
        facts,
        smoothed.notes,
    )
