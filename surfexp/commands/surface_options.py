"""Options that commands on surfaces share."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import click

Command = Callable[..., Any]
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
