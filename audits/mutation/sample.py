"""A random sample of faults, spread over the files by their size."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from audits.mutation import ROOT
from audits.mutation.change import Change, source_of
from audits.mutation.places import changes

# they move results and show them; what is planted here is numerics
FRAMEWORK = {"lab", "records", "report", "reproduction", "commands"}


def numerics() -> list[Path]:
    """Every module of the library but those of the framework, and of the studies, in order."""
    library = (
        path for path in (ROOT / "surfexp").glob("*/**/*.py") if path.relative_to(ROOT).parts[1] not in FRAMEWORK
    )
    return sorted([*library, *(ROOT / "studies").glob("*/*.py")])


def sample(count: int, seed: int) -> list[Change]:
    """Return faults in random order: the lines of all files, in a row, are picked at equal steps from a random start.

    A file with a share s of all lines that can carry a fault so gets s * count faults, rounded up or down.

    Raises
    ------
    ValueError
        If there are fewer lines than faults asked for.
    """
    generator = random.Random(seed)
    lines: list[tuple[Change, ...]] = []
    for path in numerics():
        groups = list(_by_line(path.relative_to(ROOT).as_posix(), source_of(path)))
        generator.shuffle(groups)
        lines += groups
    if not 1 <= count <= len(lines):
        raise ValueError(f"{count} faults were asked for, there is room for 1 to {len(lines)}")
    step = len(lines) / count
    start = generator.random() * step
    chosen = [_one(lines[int(start + k * step)], generator) for k in range(count)]
    generator.shuffle(chosen)
    return chosen


@cache
def _by_line(name: str, source: bytes) -> tuple[tuple[Change, ...], ...]:
    """The changes of each line of a file that can carry one."""
    lines: dict[int, list[Change]] = {}
    for change in changes(name, source):
        lines.setdefault(change.line, []).append(change)
    return tuple(map(tuple, lines.values()))


def _one(group: Sequence[Change], generator: random.Random) -> Change:
    kind = generator.choice(sorted({change.kind for change in group}))
    return generator.choice([change for change in group if change.kind == kind])
