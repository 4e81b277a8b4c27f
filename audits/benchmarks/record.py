"""What each group of lines gave, kept when it ends, so that an interrupted run or a single group costs no other one."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from audits.benchmarks import ROOT
from audits.benchmarks.line import Line
from audits.benchmarks.measurement import Cost

FOLDER = ROOT / "results" / "benchmarks"


@dataclass(frozen=True)
class Record:
    """One run of a group.

    Parameters
    ----------
    lines : tuple of Line
    compilation : float
        Processor seconds of the first call on a small case.
    conditions : str
        Versions, processor and threads.
    numerics : str
        Digest of the code that was measured.
    date : str
    earlier : dict of str to str
        What the lines of the run before gave, on the same code, by their work and rival.
    """

    lines: tuple[Line, ...]
    compilation: float
    conditions: str
    numerics: str
    date: str
    earlier: dict[str, str] = field(default_factory=dict)


def save(group: str, record: Record, folder: Path = FOLDER) -> None:
    """Keep the record of a group in place of its last one, with what that one gave."""
    folder.mkdir(parents=True, exist_ok=True)
    before = load(group, folder)
    if before and before.numerics == record.numerics:
        record = replace(record, earlier={line.name: line.result for line in before.lines})
    (folder / f"{group}.json").write_text(json.dumps(asdict(record), indent=1, default=_number), encoding="utf-8")


def load(group: str, folder: Path = FOLDER) -> Record | None:
    """Return the last record of a group, if there is one."""
    file = folder / f"{group}.json"
    if not file.exists():
        return None
    known = json.loads(file.read_text(encoding="utf-8"))
    return Record(**known | {"lines": tuple(_line(line) for line in known["lines"])})


def _number(value: Any) -> Any:
    """Return a number of numpy as one of Python."""
    return value.item()


def _line(fields: dict[str, Any]) -> Line:
    costs = {side: Cost(**fields[side]) if fields[side] else None for side in ("ours", "theirs")}
    points = tuple((size, seconds) for size, seconds in fields.get("points", ()))
    return Line(**fields | costs | {"points": points})
