"""`surfexp test`: maps of subjects tested at every vertex."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from surfexp.commands.certificate import Inputs
from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import given_maps, shown_labels
from surfexp.commands.given_surfaces import opened
from surfexp.commands.surface_options import result_option, surface_options
from surfexp.commands.surface_results import finish, ready_map
from surfexp.commands.table_file import ready_table
from surfexp.commands.table_of_subjects import names_of_maps, number, of_subjects
from surfexp.commands.terminal import echo, progress_line

if TYPE_CHECKING:
    from surfexp.contract.arrays import Floats
    from surfexp.tasks.tested_maps import PermutationTest

EXAMPLES = (
    "lh.white all.mgh --to test.npz",
    "lh.white *.thickness.mgh --subjects participants.tsv --groups sex --covariates age --to test.func.gii",
)


@click.command(**shown("test", *EXAMPLES))
@click.argument("path", metavar="SURFACE", type=click.Path())
@click.argument("map_names", metavar="MAP...", nargs=-1, required=True, type=click.Path())
@click.option(
    "--subjects", type=click.Path(), metavar="FILE", help="table of the maps, .csv or .tsv: a column names files"
)
@click.option("--in-order", is_flag=True, help="the rows of the table are in the order of the maps, whatever it names")
@click.option("--groups", metavar="COLUMN", help="the group of the first map less the other; without it the mean")
@click.option("--pairs", metavar="COLUMN", help="with --groups: which two maps belong together")
@click.option("--covariates", metavar="COLUMN,...", help="numbers that are regressed out")
@click.option("--blocks", metavar="COLUMN", help="maps that depend on one another, as those of a family")
@click.option(
    "--exchange",
    type=click.Choice(["within", "whole"]),
    default="within",
    help="maps are permuted within their block, or blocks are permuted, and flip, as wholes",
)
@click.option(
    "--rearrange",
    type=click.Choice(["auto", "flip", "permute"]),
    default="auto",
    help="flip signs, or permute maps; auto flips where a mean is tested",
)
@click.option(
    "--design", type=click.Path(), metavar="FILE", help="a linear model instead: .csv, rows in the order of maps"
)
@click.option("--contrast", metavar="NUMBER,...", help="of the columns of the design")
@click.option("--count", default=5000, help="rearrangements")
@click.option("--forming-p", default=0.001, help="uncorrected p from which on vertices form clusters")
@click.option("--one-sided", is_flag=True, help="test for positive contrasts only")
@click.option("--level", default=0.05, help="of the regions of TFCE, which are listed")
@click.option("--labels", metavar="FILE", help="parcels of the table: .annot, .label.gii, .dlabel.nii")
@click.option("--seed", default=0, help="of the random rearrangements")
@click.option("--threads", type=int, help="all cores if not given")
@click.option(
    "--table", type=click.Path(path_type=Path), metavar="FILE", help="write clusters beyond --forming-p, .csv"
)
@click.option(
    "--regions", type=click.Path(path_type=Path), metavar="FILE", help="write regions of TFCE up to --level, .csv"
)
@surface_options
@result_option()
def test(
    path: str,
    map_names: tuple[str, ...],
    subjects: str | None,
    in_order: bool,
    groups: str | None,
    pairs: str | None,
    covariates: str | None,
    blocks: str | None,
    exchange: str,
    rearrange: str,
    design: str | None,
    contrast: str | None,
    count: int,
    forming_p: float,
    one_sided: bool,
    level: float,
    labels: str | None,
    seed: int,
    threads: int | None,
    table: Path | None,
    regions: Path | None,
    target: Path,
    **given: Any,
) -> int:
    """Test maps of subjects at every vertex, corrected for all of them.

    Each MAP is a file with the maps of one or several subjects, or a map that the surface carries. The result has t, exact
    threshold-free enhancement (TFCE), and family-wise p-values by max t, cluster extent and mass, and TFCE.
    """
    import numpy as np

    from surfexp.io.csv_cells import write_columns
    from surfexp.io.map_files import side_by_side
    from surfexp.tasks.permutation_testing import permutation_test

    places = [str(Path(name).resolve()) if Path(name).is_file() else name for name in map_names]
    twice = next((name for name, place in zip(map_names, places, strict=True) if places.count(place) > 1), None)
    if twice is not None:
        raise ValueError(f"map {twice} is given more than once, each subject counts once: give it once")
    surface, files = opened(path, **given)
    read = {name: given_maps(surface, name, files, given["hemisphere"]) for name in map_names}
    values = np.column_stack([side_by_side(maps, name) for name, maps in read.items()])
    options: dict[str, Any] = {"count": count, "forming_p": forming_p, "two_sided": not one_sided, "level": level}
    options |= {"seed": seed, "exchange": exchange, "rearrange": rearrange}
    columns = {"groups": groups, "pairs": pairs, "covariates": covariates, "blocks": blocks}
    asked, said = of_subjects(subjects, files, columns, names_of_maps(read), in_order, len(read) == 1)
    asked |= _of_design(design, contrast, files)
    parcels = shown_labels(surface, labels, files, given["hemisphere"]) if labels else None
    if labels and parcels is None:
        raise ValueError(f"--labels {labels} is no file of labels, give .annot, .label.gii or .dlabel.nii")
    ready_map(target, files, surface, values, count=8)
    ready_table(table, files, "--table")
    ready_table(regions, files, "--regions")
    started = time.perf_counter()
    with progress_line("test") as progress:
        found = permutation_test(
            surface, values, **asked, **options, labels=parcels, threads=threads, progress=progress
        )
    facts = found.facts | {"seconds": time.perf_counter() - started}
    _say(found, surface.right is not None)
    for place, which in ((table, "clusters"), (regions, "regions")):
        if place is not None:
            write_columns(place, found.table(which))
    model = {name: said for name, said in (columns | {"design": design, "contrast": contrast}).items() if said}
    return finish(target, found.maps, surface, "permutation test", model | options, files, facts, (*said, *found.notes))


def _of_design(design: str | None, contrast: str | None, files: Inputs) -> dict[str, Any]:
    """The matrix of a file and the numbers of the contrast."""
    asked: dict[str, Any] = {}
    if contrast is not None:
        asked["contrast"] = [number(word, "--contrast") for word in contrast.split(",")]
    if design is not None:
        from surfexp.io.map_files import read_maps, side_by_side

        files.add(design)
        asked["design"] = side_by_side(read_maps(design, columns=len(asked.get("contrast", [0]))), design)
    return asked


def _say(found: PermutationTest, both: bool) -> None:
    """One line for each region of TFCE."""
    for one in found.regions:
        parcel = f", {next(iter(one.parcels))}" if one.parcels else ""
        side = f"{one.hemisphere} hemisphere, " if both else ""
        peak = f"{side}t {one.t:.2f} at vertex {one.peak}{parcel}, p of TFCE {one.p_tfce:.3g}"
        echo(f"region of {one.vertices} vertices, area {one.area:.4g}: {peak}")
    if not found.regions:
        echo(f"no vertex has a family-wise p of TFCE up to {found.level:g}; the least is {_least(found.p_tfce):.3g}")


def _least(values: Floats) -> float:
    import numpy as np

    return float(np.nanmin(values))
