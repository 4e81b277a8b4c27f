"""`surfexp view`: a surface that turns, in the browser or as one file."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import click

from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import label_of_bar, shown_borders, shown_map
from surfexp.commands.given_surfaces import opened
from surfexp.commands.surface_options import picture_options, result_option, surface_options
from surfexp.commands.surface_results import ready
from surfexp.commands.terminal import echo

EXAMPLES = ("lh.white", "lh.white lh.thickness --to thickness.html")


@click.command(**shown("view", *EXAMPLES))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="[MAP]", required=False, type=click.Path())
@click.option("--title", default="", show_default=False, help="of the page")
@picture_options
@surface_options
@result_option(required=False)
def view(
    path: str,
    map_name: str | None,
    title: str,
    target: Path | None,
    looks: dict[str, Any],
    **given: Any,
) -> None:
    """Turn a surface, coloured by a map or by labels.

    Without --to it is shown in the browser. A .html needs no other file; .png, .svg and .pdf are its first look.
    """
    from surfexp.tasks.viewing import check_view_target
    from surfexp.tasks.viewing import view as task

    surface, files = opened(path, **given)
    values = shown_map(surface, map_name, files, given["hemisphere"])
    looks["label"] = looks["label"] or label_of_bar(values, map_name)
    looks["borders"] = shown_borders(surface, looks["borders"], files, given["hemisphere"])
    if target is not None:
        ready(target, files, check_view_target)
    seen = task(surface, values, title=title, **looks)
    chosen = target or Path(tempfile.mkdtemp(prefix="surfexp-")) / f"{Path(path).name}.html"
    seen.save(chosen)
    echo(str(chosen))
    if target is None:
        click.launch(chosen.as_uri())
