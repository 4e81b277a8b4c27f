"""`surfexp noise`: what noise a map has, in words, and its level as a map."""

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
from surfexp.commands.terminal import echo

EXAMPLES = ("lh.white lh.thickness", "lh.white first.mgh --second again.mgh --to level.shape.gii")


@click.command(**shown("noise", *EXAMPLES))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="MAP", type=click.Path())
@click.option("--second", "second_name", type=click.Path(), help="another measurement of the same map")
@surface_options
@result_option(required=False)
def noise(path: str, map_name: str, second_name: str | None, target: Path | None, **given: Any) -> int:
    """Say what noise a map has: level, outliers, correlation.

    MAP is a file, or a map that the surface carries. With --to the level at each vertex is written.
    """
    from surfexp.tasks.noise_of_map import noise as task

    surface, files = opened(path, **given)
    values = map_of(surface, map_name, files, given["hemisphere"])
    second = map_of(surface, second_name, files, given["hemisphere"]) if second_name else None
    if target is not None:
        ready_map(target, files, surface, values)
    started = time.perf_counter()
    found = task(surface, values, second)
    seconds = time.perf_counter() - started
    if target is None:
        echo(str(found))
        return 0
    facts = found.facts | {"seconds": seconds}
    return finish(target, {"noise": found.levels}, surface, "noise", {}, files, facts, found.notes)
