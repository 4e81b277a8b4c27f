"""Random surfaces in every dialect, read by ours and by theirs, and counted."""

from __future__ import annotations

import faulthandler
import os
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from audits.reliability import array_dialects, brain_dialects, foreign_writers, mesh_dialects, vtk_dialects
from audits.reliability.readers import import_others, ours, theirs
from audits.reliability.scene import Scene, random_scene
from audits.reliability.truth import Found, Truth, difference

RIGHT, REFUSED, WRONG = "equal", "refused", "differs"
LONGEST_LINE = 300
SINGLE = 1e-6  # others keep single precision
Dialect = Callable[[Scene, np.random.Generator, Path], tuple[Path, Truth]]


@dataclass(frozen=True)
class Read:
    """One file: what came of it, and what other readers made of it.

    Parameters
    ----------
    dialect : str
    seed : int
        Of the scene.
    outcome : str
        RIGHT, REFUSED or WRONG.
    said : str
        The refusal, or the difference.
    others : dict of str to str
        By reader: nothing where it agrees with what was written, else what it makes of it.
    """

    dialect: str
    seed: int
    outcome: str
    said: str
    others: dict[str, str] = field(default_factory=dict)


def dialects() -> tuple[Dialect, ...]:
    """Return all dialects that can be written here."""
    by_hand = (vtk_dialects, mesh_dialects, brain_dialects, array_dialects)
    return (*(dialect for module in by_hand for dialect in module.DIALECTS), *foreign_writers.known())


def fuzz(count: int, seed: int = 0, others: bool = True) -> Iterator[Read]:
    """Write and read `count` files, the dialects in turn."""
    known = dialects()
    if others:
        import_others()
    for number in range(count):
        dialect = known[number % len(known)]
        with tempfile.TemporaryDirectory() as folder:
            yield read_one(dialect, seed + number, Path(folder), others)


def read_one(dialect: Dialect, seed: int, folder: Path, others: bool = True) -> Read:
    """Write a file of a dialect and read it with every reader."""
    rng = np.random.default_rng(seed)
    path, truth = dialect(random_scene(rng), rng, folder)
    outcome, said = judged(path, truth)
    found = {name: opinion(read, path, truth) for name, read in theirs(path, truth.kind)} if others else {}
    return Read(dialect.__name__, seed, outcome, said, found)


def judged(path: Path, truth: Truth) -> tuple[str, str]:
    """Read a file with ours; a refusal has to be one line that gives the expected reason."""
    try:
        said = difference(truth, ours(path, truth))
    except ValueError as error:
        line = str(error).replace(f"{path.parent}/", "")
        if len(line) > LONGEST_LINE or "\n" in line:
            return WRONG, f"a refusal that is no line: {line[:200]!r}"
        if truth.refused and truth.refused in line:
            return REFUSED, line
        return WRONG, f"refused: {line}"
    except Exception as error:
        return WRONG, f"{type(error).__name__}: {error}"
    if truth.refused:
        return WRONG, f"read, though it had to be refused ({truth.refused})"
    return (WRONG, said) if said else (RIGHT, "")


def opinion(read: Callable[[Path], Found], path: Path, truth: Truth) -> str:
    """Return where another reader differs from what was written; it reads in a process of its own, which may crash."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        faulthandler.disable()
        try:
            said = difference(truth, read(path), SINGLE)
        except BaseException as error:
            said = f"cannot read it: {type(error).__name__} {str(error)[:80]}"
        os.write(writing, said.encode("utf-8", "replace")[:4000])
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        said = pipe.read().decode("utf-8", "replace")
    status = os.waitpid(child, 0)[1]
    return f"ended by signal {status}" if status else said


def table(found: list[Read]) -> str:
    """Return a table in Markdown by dialect: files, what came of them, and which readers agree how often."""
    rows = [
        "| dialect | files | equal | refused for its reason | differs | others that agree |",
        "|---|---|---|---|---|---|",
    ]
    total: Counter[str] = Counter()
    for name in dict.fromkeys(item.dialect for item in found):
        some = [item for item in found if item.dialect == name]
        counts = Counter(item.outcome for item in some)
        total += counts
        readers = dict.fromkeys(reader for item in some for reader in item.others)
        agree = {r: [not item.others[r] for item in some if r in item.others] for r in readers}
        told = ", ".join(f"{reader} {sum(yes)} of {len(yes)}" for reader, yes in agree.items()) or "–"
        rows.append(f"| {name.replace('_', ' ')} | {len(some)} | {_cells(counts)} | {told} |")
    rows.append(f"| **all** | {total.total()} | {_cells(total)} | |")
    return "\n".join(rows) + "\n"


def _cells(counts: Counter[str]) -> str:
    return " | ".join(str(counts[outcome]) for outcome in (RIGHT, REFUSED, WRONG))
