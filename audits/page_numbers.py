"""`python -m audits.page_numbers RESULTS`: numbers in the tables of pages on studies that their experiments no longer give.

A page names its experiments (`experiment=NAME`). A number of a table counts as found where a metric of one of them, or that
as a share in percent, rounds to it. What is not found was rounded otherwise, measured elsewhere, or is of an earlier run.
"""

from __future__ import annotations

import csv
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

NAMED = re.compile(r"experiment=([a-z0-9_,]+)")
NUMBER = re.compile(r"(?<![\w.,-])-?\d*\.(\d+)(?:e(-?\d+))?(?![\w.])")
FACTORS = (1.0, 100.0)


def experiments_of(page: str) -> list[str]:
    """Return the experiments that a page names, each once.

    Examples
    --------
    >>> experiments_of("`surfexp run experiment=one,two` and `experiment=two`")
    ['one', 'two']
    """
    return list(dict.fromkeys(name for names in NAMED.findall(page) for name in names.split(",") if name))


def unknown_numbers(page: str, known: Iterable[float]) -> Iterator[tuple[str, str]]:
    """Yield the numbers in tables of a page that no known number rounds to, each with its row.

    Examples
    --------
    >>> list(unknown_numbers("| a | .33 | .51 |", [0.3349, 0.5049]))
    [('.51', '| a | .33 | .51 |')]
    """
    values = np.array(sorted(known))
    for row in (line for line in page.splitlines() if line.startswith("|")):
        for found in NUMBER.finditer(row):
            step = 10.0 ** (int(found[2] or 0) - len(found[1]))
            number = float(found[0])
            if not any((np.abs(values * factor - number) <= (0.5 + 1e-6) * step).any() for factor in FACTORS):
                yield found[0], row


def numbers_of(results: Path, names: Iterable[str]) -> list[float]:
    """Return all numbers in the tables of metrics of those experiments that have been run."""
    found: list[float] = []
    for file in (results / name / "metrics.csv" for name in names):
        if file.exists():
            with file.open(newline="", encoding="utf-8") as rows:
                for cell in (cell for row in csv.reader(rows) for cell in row):
                    try:
                        found.append(float(cell))
                    except ValueError:
                        continue
    return [number for number in found if np.isfinite(number)]


def main(results: Path, docs: Path) -> int:
    """Print what is not found, page by page; return how many numbers that is."""
    missing = 0
    for page in sorted(docs.glob("*.md")):
        text = page.read_text(encoding="utf-8")
        known = numbers_of(results, experiments_of(text))
        for number, row in unknown_numbers(text, known) if known else ():
            missing += 1
            print(f"{page.name}: {number} in {row[:90]}")
    return missing


if __name__ == "__main__":
    sys.exit(1 if main(Path(sys.argv[1]), Path(__file__).resolve().parent.parent / "docs") else 0)
