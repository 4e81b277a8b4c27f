"""`python -m audits.benchmarks [--quick] [NAME ...]`: run groups of lines and write BENCHMARKS.md of the last run of each."""

from __future__ import annotations

import argparse
import importlib
import time
from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from audits.benchmarks import ROOT
from audits.benchmarks.gap_curves import gap_curves
from audits.benchmarks.line import Line
from audits.benchmarks.record import Record, load, save
from audits.benchmarks.table import conditions, describe, page, section_of
from surfexp.figures.convergence_plot import convergence_plot
from surfexp.figures.figure import Figure
from surfexp.reproduction.stamp import state_of_code

PAGE = ROOT / "BENCHMARKS.md"
PICTURE = ROOT / "docs" / "gap_against_time.svg"
# heading of a section, the figure of its lines that have points, and its axes
FIGURES = {
    "Growth": (ROOT / "docs" / "seconds_against_vertices.svg", "vertices", "seconds of processor"),
    "What a user waits for": (ROOT / "docs" / "seconds_against_stages.svg", "stages", "seconds by the clock"),
}

SECTIONS = {
    "Variational image processing": (
        "denoising",
        "slopes",
        "filters",
        "segmentation",
        "parametrization",
        "scaling",
        "threads",
    ),
    "Laplace-Beltrami eigen-geometry": (
        "eigenpairs",
        "eigenpairs_range",
        "hierarchy",
        "brain_modes",
        "nodal_domains",
        "assembly",
    ),
    "Sparse factorisation": ("factorisation",),
    "Null models": ("nulls", "permutations"),
    "Skeletons": ("skeleton", "vessels"),
    "Spectral distances": ("embedding",),
    "Growth": ("growth",),
    "Whole calls": ("whole_calls",),
    "What a user waits for": ("large_mesh", "waiting", "commands", "cohort"),
}


def main() -> None:
    """Run the groups that are named, all by default."""
    names = [name for group in SECTIONS.values() for name in group]
    parser = argparse.ArgumentParser(prog="benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"groups of lines: {', '.join(names)}")
    parser.add_argument("--quick", action="store_true", help="small sizes, to see that all runs; writes nothing")
    options = parser.parse_args()
    for unknown in set(options.names) - set(names):
        parser.error(f"group {unknown!r} is unknown, choose from {', '.join(names)}")
    print(conditions())
    numerics = state_of_code()[0]
    for name in options.names or names:
        group = importlib.import_module(f"audits.benchmarks.{name}")
        begin = time.process_time()
        group.warm_up()
        compilation = time.process_time() - begin
        found = group.lines(options.quick)
        print("\n".join(describe(line) for line in found), flush=True)
        if not options.quick:
            save(name, Record(tuple(found), compilation, conditions(), numerics, f"{datetime.now(UTC):%Y-%m-%d}"))
    if not options.quick:
        _write_page(names)


def _write_page(names: list[str]) -> None:
    """Write the sections of which every group has been run here, take over the others, and say which were not."""
    known = {name: record for name in names if (record := load(name)) is not None}
    earlier = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
    sections = {
        heading: {name: known[name] for name in groups} if set(groups) <= set(known) else {}
        for heading, groups in SECTIONS.items()
    }
    unknown = [heading for heading, records in sections.items() if not records and not section_of(earlier, heading)]
    if missing := [name for name in names if name not in known]:
        print(f"Not run here: {', '.join(missing)}; sections that need them stay as they are in {PAGE.name}")
    if unknown:
        print(f"{PAGE.name} is as it was: it has no section {', '.join(unknown)}")
        return
    if sections["Variational image processing"]:
        PICTURE.write_text(gap_curves().svg, encoding="utf-8")
    for heading, (file, axis, cost) in FIGURES.items():
        found = [line for record in sections[heading].values() for line in record.lines if line.points]
        if found:
            file.write_text(growth_plot(found, axis, cost).svg, encoding="utf-8")
    PAGE.write_text(page(sections, earlier), encoding="utf-8")


def growth_plot(lines: Sequence[Line], axis: str, cost: str) -> Figure:
    """Draw how the seconds of lines grow."""
    columns = {line.curve: np.array(line.points).T for line in lines}
    curves = {name: (sizes, seconds) for name, (sizes, seconds) in columns.items()}
    return convergence_plot(curves, x_label=axis, y_label=cost, title=f"Seconds against {axis}")


if __name__ == "__main__":
    main()
