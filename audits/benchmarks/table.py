"""The page that the command writes."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version

from audits.benchmarks.line import Line
from audits.benchmarks.measurement import Cost
from audits.benchmarks.record import Record

PACKAGES = (
    "numpy",
    "scipy",
    "numba",
    "cholespy",
    "qdldl",
    "libigl",
    "cvxpy",
    "clarabel",
    "lapy",
    "scikit-sparse",
    "potpourri3d",
    "skeletor",
    "kimimaro",
    "vtk",
)
HEAD = """# Benchmarks

Made by `make bench`. A line with a rival is a ratio of processor seconds, ours and the rival's measured in turn in one
run; a line without one is a limit. Seconds are medians of as many runs on either side: the column says how many, one
where the rival takes more than 40 s. One thread, unless the line says two (then wall seconds are compared). What each
side reached, and on which scale a gap is taken, stands below its table, and what of the set-up is counted. Compilation
is excluded and listed at the end. Packages run on their own operators and factorisations; the methods as published, the
conformal and the level-set methods were written here and run on ours. A rival that is not installed
(`pip install 'surfexp[bench]'`) counts as not met. Beside what was seen stands what the run before gave on the same
code: how far figures spread. Why some are not met stands in docs/why_not_met.md.
"""
WHEN = re.compile(r"^\| (\w+) \| (\d{4}-\d\d-\d\d \| .*)$", re.MULTILINE)
COLUMNS = "| work | rival | asked | seen | run before | verdict | ours, CPU (wall) s | rival, CPU (wall) s | runs |"


def conditions() -> str:
    """Return versions, processor and threads in one line."""
    found = []
    for package in PACKAGES:
        try:
            found.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            found.append(f"{package} not installed")
    python = f"Python {platform.python_version()} on {platform.machine()}, {os.cpu_count()} processors, 1 thread"
    return f"{python}; {', '.join(found)}."


def page(sections: Mapping[str, Mapping[str, Record]], earlier: str = "") -> str:
    """Return the page as Markdown.

    Parameters
    ----------
    sections : mapping of heading to its groups' records by name
        Without records, the section of `earlier` is taken over as it is.
    earlier : str, optional
        The page as it was.
    """
    groups = {name: record for records in sections.values() for name, record in records.items()}
    known = [] if all(sections.values()) else re.findall(r"^Python .*$", earlier.partition("\n## ")[0], re.MULTILINE)
    conditions = list(dict.fromkeys([*known, *(record.conditions for record in groups.values())]))
    parts = [HEAD, *(f"{line}\n" for line in conditions)]
    for heading, records in sections.items():
        if not records:
            parts.append(section_of(earlier, heading))
            continue
        lines = [line for record in records.values() for line in record.lines]
        rows = [_row(line, record.earlier) for record in records.values() for line in record.lines]
        parts.append("\n".join([f"## {heading}\n", COLUMNS, "|---|---|---|---|---|---|---|---|---|", *rows]) + "\n")
        parts.append("\n".join(detail for line in lines if (detail := _detail(line))) + "\n")
    parts.append(
        "## Seconds against size\n\n"
        "![Processor seconds of the kernels against vertices](docs/seconds_against_vertices.svg)\n"
        "\n![Wall seconds of whole runs against their stages](docs/seconds_against_stages.svg)\n"
    )
    parts.append(
        "## Gap against time\n\n![Certified relative gap of ROF against processor seconds](docs/gap_against_time.svg)\n"
    )
    kept = (
        "Ratios hold, seconds vary with the machine and the hour. Compilation is that of the "
        "first call on a small case,"
    )
    when = {} if all(sections.values()) else dict(WHEN.findall(earlier))
    when |= {name: f"{record.date} | {record.numerics} | {record.compilation:.1f} |" for name, record in groups.items()}
    rows = [f"| {name} | {told}" for name, told in when.items()]
    head = ["| group | measured | state of the numerics | compilation, s |", "|---|---|---|---|"]
    parts.append("\n".join(["## When\n", f"{kept} or of reading it from the cache on disk.\n", *head, *rows]) + "\n")
    return "\n".join(parts)


def section_of(text: str, heading: str) -> str:
    """Return a section of a page with its heading, nothing if it has none."""
    begin = text.find(f"## {heading}\n")
    return text[begin:].partition("\n\n## ")[0] + "\n" if begin >= 0 else ""


def describe(line: Line) -> str:
    """Return the line as text for the terminal."""
    costs = f"ours {_cost(line.ours)}, rival {_cost(line.theirs)}"
    return f"{line.work} | {line.rival}\n    {line.result}, asked {line.target}: {line.verdict}; {costs}\n    {_facts(line)}"


def _row(line: Line, earlier: Mapping[str, str]) -> str:
    costs = (_cost(line.ours), _cost(line.theirs), str(line.ours.runs) if line.ours else "–")
    before = earlier.get(line.name, "–")
    cells = (line.work, line.rival, line.target, line.result, before, line.verdict, *costs)
    return f"| {' | '.join(cells)} |"


def _detail(line: Line) -> str:
    return f"- {line.name}: {_facts(line)}." if _facts(line) else ""


def _facts(line: Line) -> str:
    return "; ".join(fact for fact in (line.accuracy, line.note) if fact)


def _cost(cost: Cost | None) -> str:
    return "–" if cost is None else f"{cost.cpu:.3g} ({cost.wall:.3g})"
