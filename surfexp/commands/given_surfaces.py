"""Surfaces as a command is given them: a file, or LEFT+RIGHT of both hemispheres, and what belongs to it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.commands.certificate import Inputs
from surfexp.commands.given_maps import add_files, both_of, file_of
from surfexp.commands.terminal import echo

if TYPE_CHECKING:
    from surfexp.mesh.surface import Surface


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


def check_one_hemisphere(*paths: str) -> None:
    """Refuse LEFT+RIGHT where one hemisphere is needed, naming the files to give.

    Raises
    ------
    ValueError
        If both hemispheres are given.
    """
    for path in paths:
        pair = both_of(path)
        if not isinstance(pair, str) and all(Path(one).is_file() for one in pair.values()):
            raise ValueError(f"{path} is both hemispheres, one is needed: give {pair['left']} or {pair['right']}")


def notes_of(first: str, second: str, *notes: tuple[str, ...]) -> tuple[str, ...]:
    """Return the notes of two surfaces, each with its file."""
    pairs = zip((first, second), notes, strict=True)
    return tuple(dict.fromkeys(f"{path}: {note}" for path, said in pairs for note in said))
