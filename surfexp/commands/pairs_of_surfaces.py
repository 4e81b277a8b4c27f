"""Commands that compare two surfaces by their modes: the spectral distance, and modes aligned."""

from __future__ import annotations

import time
from pathlib import Path

import click

from surfexp.commands.certificate import Inputs
from surfexp.commands.click_command import shown
from surfexp.commands.given_surfaces import check_one_hemisphere, notes_of, surface_of
from surfexp.commands.proof_pages import ready_proof, save_proof
from surfexp.commands.surface_options import proof_option, repair_option, result_option
from surfexp.commands.surface_results import finish, ready
from surfexp.commands.terminal import echo, progress_line

EXAMPLES = {
    "distance": ("a.ply b.ply -n 20", "a.ply b.ply --to map.npz"),
    "align": ("a.ply b.ply -k 50 --to aligned.npz", "lh.white other/lh.white -k 20 --to aligned.npz"),
}


@click.command(**shown("distance", *EXAMPLES["distance"]))
@click.argument("first", type=click.Path())
@click.argument("second", type=click.Path())
@click.option("-n", "count", default=20, help="number of eigenfunctions")
@click.option("--limit", type=int, help="most evaluations of the search; by default about a minute of them")
@click.option("--points", type=int, help="vertices that stand for the others; by default 7,000 above 44,721, else all")
@repair_option
@proof_option
@result_option(required=False)
def distance(
    first: str,
    second: str,
    count: int,
    limit: int | None,
    points: int | None,
    repair: bool,
    target: Path | None,
    proof: Path | None,
) -> None:
    """Measure the spectral distance of two surfaces, with a proved lower bound.

    The signs of the eigenfunctions are printed too; --to writes the correspondence.
    """
    import numpy as np

    from surfexp.io.written_maps import check_map_target
    from surfexp.tasks.distances import distance as task

    check_one_hemisphere(first, second)
    files = Inputs(first, second)
    ready_proof(proof, files)
    one, other = surface_of(first, repair), surface_of(second, repair)
    if target is not None:
        ready(target, files, check_map_target, hemisphere=other.hemisphere)
    started = time.perf_counter()
    with progress_line("distance") as progress:
        found = task(one, other, count, limit=limit, points=points, progress=progress)
    signs = "".join("+" if sign > 0 else "-" for sign in np.diag(found.basis))
    bound = "proved least" if found.optimal else f"not proved, at least {found.lower_bound:.6g}"
    echo(f"distance {found.value:.6g} ({bound}), signs {signs}")
    if target is None:
        for note in found.notes:
            echo(note, err=True)
    else:
        facts = {
            "value": found.value,
            "lower_bound": found.lower_bound,
            "optimal": found.optimal,
            "signs": signs,
            "seconds": time.perf_counter() - started,
        }
        partner = found.correspondence
        if one.file is not None:
            partner = np.where(partner < 0, partner, one.file.origin[partner])
        read = notes_of(first, second, one.notes, other.notes)
        maps = {"correspondence": partner.astype(float)}
        options = {"n": count, "limit": limit, "points": points, "repair": repair}
        finish(target, maps, other, found.method, options, files, facts, found.notes, read)
    save_proof(proof, found, one, other)


@click.command(**shown("align", *EXAMPLES["align"]))
@click.argument("first", type=click.Path())
@click.argument("second", type=click.Path())
@click.option("-k", "count", default=50, help="number of modes after the constant")
@repair_option
@result_option()
def align(first: str, second: str, count: int, repair: bool, target: Path) -> None:
    """Align the modes of one surface with those of another.

    Signs, order and rotations of the modes of SECOND become those of FIRST.
    """
    from surfexp.io.written_maps import check_map_target
    from surfexp.tasks.mode_alignment import align as task

    check_one_hemisphere(first, second)
    files = Inputs(first, second)
    if target.suffix.lower() != ".npz":
        raise ValueError(f"{target} cannot hold the aligned modes and their basis, two arrays: choose .npz")
    one, other = surface_of(first, repair), surface_of(second, repair)
    ready(target, files, check_map_target, hemisphere=other.hemisphere)
    started = time.perf_counter()
    with progress_line("align") as progress:
        found = task(one, other, count, progress=progress)
    facts = {
        "value": found.value,
        "lower_bound": found.lower_bound,
        "optimal": found.optimal,
        "blocks": len(found.blocks),
        "seconds": time.perf_counter() - started,
    }
    read = notes_of(first, second, one.notes, other.notes)
    finish(target, found, other, "mode alignment", {"k": count, "repair": repair}, files, facts, found.notes, read)
