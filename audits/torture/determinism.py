"""`python -m audits.torture.determinism [PYTHON ...]`: the main job on other processors, threads and Pythons, number by number.

Each PYTHON is an interpreter of another environment in which surfexp is installed.
"""

from __future__ import annotations

import csv
import io
import os
import platform
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from audits.torture import ROOT
from audits.torture.laboratory import store_bytes

PAGE = ROOT / "docs" / "determinism.md"
# OpenBLAS, in numpy's and scipy's wheels, takes the kernels of the processor that it is told
PROCESSORS = ("NEHALEM", "HASWELL", "ZEN")
ONE = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
TWO = {"OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "2"}
IDENTITY = ("comparison", "leaf", "seconds", "failure")
# counts of steps and places of a threshold have no certificate: they follow from rounding where two are nearly equal
SMALLEST = 1e-300
HEAD = """# Determinism

Made by `python -m audits.torture.determinism`: `surfexp run` in an empty results folder, again and again. *Stored files that
are equal*: byte by byte, of all that the stages stored. *Energies beyond their gaps*: rows whose energy differs from
that of the first run by more than the larger of both certified gaps, which no two results for one problem may do.
With another Python every stored file has another name (a key holds the digest of the code as that Python parses it), so
that only numbers can be compared. Seconds depend on what else the machine did.

The experiment has no surface that is deformed at random and remeshed. Where edges are split and turned by their
lengths, a difference in the last digit makes another mesh: two subjects of `sulci_statistics` have other meshes with
kernels for Haswell or Prescott than with those of this machine, lengths that differ by up to .5 mm where the ends are
known, and by up to 43 % where regions are found anew. Such populations are another draw with other kernels, and a verdict
near its bound may turn: whole runs of that experiment gave a p-value of .0002 and of .0019, with a bound of .001.

"""


@dataclass
class Run:
    """What one run left behind.

    Parameters
    ----------
    name : str
    code : int
        Exit code.
    rows : list of dict
        The table, with all digits.
    stored : dict of str to str
        SHA-256 of every stored file.
    seconds : float
    """

    name: str
    code: int
    rows: list[dict[str, str]]
    stored: dict[str, str]
    seconds: float
    verdicts: list[tuple[str, str]] = field(init=False)

    def __post_init__(self) -> None:
        """Note which rows converged and which failed."""
        self.verdicts = [(row.get("converged", ""), row.get("failure", "")) for row in self.rows]


def run(name: str, python: str, environment: dict[str, str]) -> Run:
    """Do the main job in an empty folder."""
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as text:
        results = Path(text) / "results"
        command = [python, "-P", "-m", "surfexp.commands.command_line"]
        given = os.environ | ONE | environment
        done = subprocess.run(
            [*command, "run", f"results={results}"], cwd=ROOT, env=given, capture_output=True, check=False
        )
        seconds = time.monotonic() - begin
        shown = subprocess.run(
            [*command, "table", "quickstart", "--results", str(results), "--format", "csv"],
            cwd=ROOT, env=given, capture_output=True, text=True, check=True,
        )  # fmt: skip
        rows = list(csv.DictReader(io.StringIO(shown.stdout)))
        return Run(name, done.returncode, rows, store_bytes(results), seconds)


def compared(first: Run, other: Run) -> tuple[str, bool]:
    """Return the row of the table for another run, and whether verdicts and certificates agree."""
    same = sum(other.stored.get(place) == known for place, known in first.stored.items())
    good = other.code == first.code and other.verdicts == first.verdicts and len(other.rows) == len(first.rows)
    largest, where, beyond = 0.0, "", 0
    for mine, theirs in zip(first.rows, other.rows, strict=False):
        for column, value in mine.items():
            if column not in IDENTITY and _number(value) is not None and _number(theirs.get(column, "")) is not None:
                difference = _relative(_number(value), _number(theirs[column]))
                if difference > largest:
                    largest, where = difference, f"{column} of {mine['solver.name']}, {mine['operator.name']}"
        if mine.get("energy") and mine.get("gap"):
            apart = abs(float(mine["energy"]) - float(theirs["energy"]))
            beyond += apart > max(float(mine["gap"]), float(theirs["gap"]))
    verdicts = "the same" if good else "**others**"
    cells = [other.name, verdicts, f"{same} of {len(first.stored)}", f"{largest:.1e}" if largest else "0", where]
    return f"| {' | '.join([*cells, str(beyond), f'{other.seconds:.0f}'])} |", good and not beyond


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _relative(a: float | None, b: float | None) -> float:
    assert a is not None and b is not None
    return abs(a - b) / max(abs(a), abs(b), SMALLEST)


def main() -> None:
    """Write docs/determinism.md; end with 1 where a verdict or a certificate differs."""
    own = f"Python {platform.python_version()}"
    first = run(f"{own}, one thread", sys.executable, {})
    plans = [(f"{own}, one thread, again", sys.executable, {}), (f"{own}, two threads", sys.executable, TWO)]
    plans += [
        (f"{own}, kernels for {name.capitalize()}", sys.executable, {"OPENBLAS_CORETYPE": name}) for name in PROCESSORS
    ]
    for python in sys.argv[1:]:
        said = subprocess.run([python, "--version"], capture_output=True, text=True, check=True).stdout.strip()
        plans.append((f"{said}, one thread", python, {}))
    rows, good = [], True
    for name, python, environment in plans:
        row, fits = compared(first, run(name, python, environment))
        print(row, flush=True)
        rows.append(row)
        good &= fits
    facts = f"The first run: {first.name}, {len(first.rows)} rows, exit code {first.code}, {first.seconds:.0f} s.\n\n"
    titles = ("run", "rows that converged or failed", "stored files that are equal", "largest relative difference",
              "of", "energies beyond their gaps", "seconds")  # fmt: skip
    head = f"| {' | '.join(titles)} |\n|{'---|' * len(titles)}\n"
    PAGE.write_text(HEAD + facts + head + "\n".join(rows) + "\n", encoding="utf-8")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
