"""`surfexp nulls`: null maps of a map, and the test of its correlation with another."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, Literal

import click

from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import map_of
from surfexp.commands.given_surfaces import opened
from surfexp.commands.surface_options import result_option, surface_options
from surfexp.commands.surface_results import finish, ready_map
from surfexp.commands.terminal import echo, progress_line

EXAMPLES = ("lh.white lh.thickness lh.sulc", "lh.white lh.thickness --count 100 --to nulls.npz")


@click.command(**shown("nulls", *EXAMPLES))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_name", metavar="MAP", type=click.Path())
@click.argument("other_name", metavar="[OTHER]", required=False, type=click.Path())
@click.option(
    "--method",
    type=click.Choice(["auto", "eigenstrapping", "variogram"]),
    default="auto",
    help="auto: eigenstrapping where modes hold what is smooth in the map, else variograms",
)
@click.option("--count", default=1000, help="null maps")
@click.option("--modes", default=400, help="of eigenstrapping")
@click.option("--seed", default=0, help="of the null maps")
@surface_options
@result_option(required=False)
def nulls(
    path: str,
    map_name: str,
    other_name: str | None,
    method: Literal["auto", "eigenstrapping", "variogram"],
    count: int,
    modes: int,
    seed: int,
    target: Path | None,
    **given: Any,
) -> int:
    """Make null maps of a map, and tell its correlation with another from chance.

    MAP and OTHER are files, or maps that the surface carries. With OTHER the correlation by area is printed with its p-value
    and interval. With --to the null maps are written; they are as smooth as MAP and otherwise random.
    """
    from surfexp.tasks.comparison_of_maps import chosen_null_maps, compare_maps

    if other_name is None and target is None:
        raise ValueError("nothing to do: give OTHER to compare with, or --to FILE for the null maps")
    surface, files = opened(path, **given)
    values = map_of(surface, map_name, files, given["hemisphere"])
    other = map_of(surface, other_name, files, given["hemisphere"]) if other_name else None
    if target is not None:
        ready_map(target, files, surface, values, *([] if other is None else [other]), channels=count)
    options: dict[str, Any] = {"method": method, "count": count, "modes": modes, "seed": seed}
    started = time.perf_counter()
    with progress_line("nulls") as progress:
        found = (
            chosen_null_maps(surface, values, **options, progress=progress)
            if other is None
            else compare_maps(surface, values, other, **options, progress=progress)
        )
    if isinstance(found, tuple):
        made, reason = found
        facts, notes = made.certificate, (reason, *made.notes)
    else:
        made, facts, notes = found.surrogates, found.facts, (found.reason, *found.notes)
        low, high = found.interval
        echo(
            f"r = {found.r:.3f}, 95 % interval {low:.3f} to {high:.3f}, p = {found.p:.3g} by {len(found.null):,} null maps"
        )
    if target is None:
        for note in notes:
            echo(note)
        return 0
    facts = facts | {"seconds": time.perf_counter() - started}
    return finish(target, {"null": made.values}, surface, made.method, options, files, facts, notes)
