"""What every command on surfaces shares: its arguments, its progress line, and how its result leaves."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from surfexp.commands.certificate import Inputs, write_certificate
from surfexp.commands.given_maps import add_files, both_of, file_of
from surfexp.commands.terminal import echo

if TYPE_CHECKING:
    from surfexp.contract.arrays import Floats
    from surfexp.mesh.surface import Surface

Command = Callable[..., Any]
NOT_CERTIFIED = 3
BOTH_HELP = "Both hemispheres are one surface: write LEFT+RIGHT for each file, as lh.white+rh.white lh.sulc+rh.sulc."


repair_option = click.option(
    "--repair", is_flag=True, help="repair a defective mesh and say how, instead of refusing it"
)


def surface_options(command: Command) -> Command:
    """Add the options of a surface: mask, maps, labels, unit, repair, and to its help how both hemispheres are written."""
    command.__doc__ = f"{command.__doc__}\n\n    {BOTH_HELP}"
    inside = "part to work on: .label, labels (FILE or FILE:NAME,NAME), or a map that is 0 outside"
    options: list[Callable[[Command], Command]] = [
        click.option("--mask", type=click.Path(), metavar="FILE", help=inside),
        click.option(
            "--map", "maps", multiple=True, type=click.Path(), metavar="NAME=FILE", help="attach a map; repeatable"
        ),
        click.option("--unit", default="", show_default=False, help="unit of length, for colour bars and tables"),
        click.option("--hemisphere", type=click.Choice(["left", "right"]), help="overrides what the files say"),
        repair_option,
    ]
    for option in reversed(options):
        command = option(command)
    return command


def picture_options(command: Command) -> Command:
    """Add the options of a picture (sides, colours, limits, lines), handed on as `looks`, as `sx.plot` and `sx.view` take them."""
    options: list[Callable[[Command], Command]] = [
        click.option(
            "--views", metavar="NAME,...", help="lateral, medial, left, right, front, back, top, bottom, oblique"
        ),
        click.option("--colormap", help="a name of matplotlib's"),
        click.option("--limits", nargs=2, type=float, metavar="LOW HIGH", help="ends of the colour bar"),
        click.option("--contours", multiple=True, type=float, metavar="LEVEL", help="draw a line; repeatable"),
        click.option("--borders", metavar="FILE", help="draw the borders of labels: .annot, .label.gii, .dlabel.nii"),
        click.option("--label", help="of the colour bar; by default the file's name without hemisphere and format"),
    ]

    @wraps(command)
    def gathered(map_name: str | None, **given: Any) -> Any:
        looks = {name: given.pop(name) or None for name in ("views", "colormap", "limits", "contours", "borders")}
        if looks["views"]:
            looks["views"] = [name.strip() for name in looks["views"].split(",")]
        looks["label"] = given.pop("label") or ""
        return command(map_name=map_name, looks=looks, **given)

    decorated: Command = gathered
    for option in reversed(options):
        decorated = option(decorated)
    return decorated


def label_of_bar(values: Any, map_name: str | None) -> str:
    """What the colour bar of a file's map is called: by its name without folder and format, or by that of each map in it."""
    from surfexp.io.hemisphere import common_name
    from surfexp.io.quantity_of_file import quantity_named

    if isinstance(values, Mapping) or not map_name:
        return ""
    pair = both_of(map_name)
    name = Path(pair).name if isinstance(pair, str) else common_name(*(Path(one).name for one in pair.values()))
    return quantity_named(name)


def result_option(required: bool = True) -> Callable[[Command], Command]:
    """Add `--to FILE`: the suffix decides about the format."""
    return click.option(
        "--to", "target", type=click.Path(path_type=Path), required=required, help="result; the suffix decides"
    )


def proof_option(command: Command) -> Command:
    """Add `--proof FILE`: a page that computes the certificate again where it is read."""
    chosen: Command = click.option(
        "--proof", type=click.Path(path_type=Path), help="also write a .html that proves the result where it is read"
    )(command)
    return chosen


def save_proof(path: Path | None, result: Any, *surfaces: Any) -> None:
    """Write the page of a result, where one was asked for."""
    if path is not None:
        from surfexp.tasks.proving import proof_page

        proof_page(result, *surfaces).save(path)
        echo(f"{path}: open it in any browser, it computes the certificate again")


def ready_proof(path: Path | None, files: Inputs) -> None:
    """Refuse a page that cannot be written, before anything is computed."""
    if path is not None:
        from surfexp.tasks.proving import check_proof_target

        ready(path, files, check_proof_target)


def opened(
    path: str, mask: str | None, maps: tuple[str, ...], unit: str, hemisphere: str | None, repair: bool
) -> tuple[Surface, Inputs]:
    """Return the surface that the arguments describe, and the files that went into it."""
    named: dict[str, str] = {}
    for item in maps:
        name, _, file = item.partition("=")
        if not (name and file):
            raise ValueError(f"--map {item}: write NAME=FILE")
        if name in named:
            raise ValueError(f"--map {item}: {name!r} is {named[name]} already, give it another name")
        named[name] = file
    pair = both_of(path)
    if isinstance(pair, str):
        files = Inputs(path, *named.values(), *([file_of(mask)] if mask else []))
        given: dict[str, Any] = {"maps": named, "mask": mask, "hemisphere": hemisphere or ""}
    else:
        if hemisphere is not None:
            raise ValueError(f"--hemisphere {hemisphere} names one side, {path} is both: leave it out")
        given = {"maps": {name: both_of(file) for name, file in named.items()}, "mask": both_of(mask) if mask else None}
        files = Inputs(*pair.values())
        for one in (*given["maps"].values(), *([given["mask"]] if mask else [])):
            add_files(files, one)
    return surface_of(path, repair, unit=unit, **given), files


def surface_of(path: str, repair: bool, **given: Any) -> Surface:
    """Return the surface of a file, or of LEFT+RIGHT, read as `sx.read` does; its notes are said."""
    from surfexp.tasks.files import read

    pair = both_of(path)
    surface = read(path, repair=repair, **given) if isinstance(pair, str) else read(**pair, repair=repair, **given)
    for note in surface.notes:
        echo(f"{path}: {note}", err=True)
    return surface


def notes_of(first: str, second: str, *notes: tuple[str, ...]) -> tuple[str, ...]:
    """Return the notes of two surfaces, each with its file."""
    pairs = zip((first, second), notes, strict=True)
    return tuple(dict.fromkeys(f"{path}: {note}" for path, said in pairs for note in said))


def named_as(maps: dict[str, Floats], values: Floats, target: Path) -> dict[str, Floats]:
    """Give the columns of a result the names of the maps that it was made of, where its format has room.

    A colour is rounded to whole numbers from 0 to 255 in PLY, and a line says so.
    """
    import numpy as np

    from surfexp.mesh.vertex_colours import NAMES

    if len(maps) == 1 and next(iter(maps)) in NAMES and target.suffix.lower() == ".ply" and np.isfinite(values).all():
        values = np.clip(np.rint(values), 0.0, 255.0)
        echo(f"{target.name}: colours are rounded to whole numbers from 0 to 255, as viewers read them.", err=True)
    if len(maps) == 1 or not has_room_for_names(target):
        return {next(iter(maps)): values}
    widths = [1 if part.ndim == 1 else part.shape[1] for part in maps.values()]
    parts = np.split(values, np.cumsum(widths)[:-1], axis=1)
    return {name: part[:, 0] if part.shape[1] == 1 else part for name, part in zip(maps, parts, strict=True)}


def has_room_for_names(target: Path) -> bool:
    """Whether the format of a file holds several maps by name, alone or beside their surface."""
    from surfexp.io.writing import WITH_MAPS
    from surfexp.io.written_maps import holds_names

    return holds_names(target) or target.suffix.lower() in WITH_MAPS


def files_made(target: Path, result: Any, surface: Surface | None = None) -> str:
    """Name the files that a result was written to."""
    from surfexp.tasks.written_files import places

    return " and ".join(map(str, places(target, result, surface)))


def ready(target: Path, files: Inputs, check: Callable[..., None], **wanted: Any) -> None:
    """Refuse a result that cannot be written, or would overwrite what it is made of, before anything is computed.

    Parameters
    ----------
    target : Path
    files : Inputs
    check : callable
        Refuses targets of the kind of the result.
    **wanted
        What `check` has to know of the result beside the target.

    Raises
    ------
    ValueError
        Naming what is wrong with the target.
    """
    from surfexp.io.hemisphere import written_files

    check(target, **wanted)
    for file in written_files(target, wanted.get("hemisphere") or ""):
        files.refuse_to_overwrite(file)


def ready_map(target: Path, files: Inputs, surface: Surface, *maps: Any, **wanted: Any) -> None:
    """Refuse a file that maps on a surface, NaN where it has no vertex or a map no value, cannot be written to, as `ready`."""
    import numpy as np

    from surfexp.tasks.written_targets import check_target

    outside = surface.mask is not None and not surface.mask.all()
    faces_at = np.bincount(surface.mesh.faces.ravel(), minlength=len(surface.mesh.vertices))
    unknown = outside or not faces_at.all() or any(np.isnan(values).any() for values in maps)
    ready(target, files, check_target, hemisphere=surface.hemisphere, unknown=unknown, **wanted)


@contextmanager
def progress_line(label: str) -> Iterator[Callable[[int, float], None]]:
    """Yield a progress callback that keeps one line of the terminal up to date, with the elapsed time; silent without one."""
    started, last = time.monotonic(), [0.0]
    shown = sys.stderr.isatty()

    def report(step: int, rest: float) -> None:
        now = time.monotonic()
        if shown and now - last[0] > 0.2:
            last[0] = now
            echo(f"\r{label}: {step:,}, {rest:.1e} left, {now - started:.0f} s \x1b[K", nl=False, err=True)

    yield report
    if shown and last[0]:
        echo("\r\x1b[K", nl=False, err=True)


def finish(
    target: Path,
    result: Any,
    surface: Surface | None,
    method: str,
    options: dict[str, Any],
    files: Inputs,
    facts: dict[str, Any],
    notes: tuple[str, ...] = (),
    read: tuple[str, ...] | None = None,
) -> int:
    """Write a result with its certificate, and say both in one line.

    Parameters
    ----------
    target : Path
    result : object
    surface : Surface, optional
        That on whose vertices the result is.
    method : str
    options, files, facts
        Of the certificate.
    notes : tuple of str
        Of the result: they are said, and in the certificate.
    read : tuple of str, optional
        Of the surfaces that it is made of, default that one: they were said when those were read, and are in the certificate.

    Returns
    -------
    int
        3 where the certificate says that something did not converge or is not proved complete, else 0.
    """
    from surfexp.tasks.written_files import written

    notes = (*notes, *written(target, result, surface))
    if read is None:
        read = surface.notes if surface is not None else ()
    said = tuple(dict.fromkeys((*read, *notes)))
    certificate = write_certificate(target, method, options, files, facts, said)
    for note in notes:
        echo(note, err=True)
    shown = ", ".join(f"{name} {_short(value)}" for name, value in facts.items() if value is not None)
    echo(f"{files_made(target, result, surface)}: {shown} (certificate: {certificate.name})")
    return NOT_CERTIFIED if facts.get("converged") is False or facts.get("complete") is False else 0


def _short(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
