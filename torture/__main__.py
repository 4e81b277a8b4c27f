"""`python -m torture [GROUP ...]`: run what goes wrong, print what came of it, and write docs/reliability.md."""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path

from torture import ROOT
from torture.bad_files import bad_files
from torture.case import HUNG, OUTCOMES, WRONG, Ended
from torture.damages import damages
from torture.kills import drivers, kills
from torture.misdeeds import misdeeds
from torture.names import names
from torture.requests import requests
from torture.strangers import strangers

GROUPS: dict[str, Callable[[], Iterator[Ended]]] = {
    "files": bad_files,
    "requests": requests,
    "damages": damages,
    "strangers": strangers,
    "names": names,
    "misdeeds": misdeeds,
    "kills": kills,
    "drivers": drivers,
}
PAGE = ROOT / "docs" / "reliability.md"
FOLDER = ROOT / "results" / "torture"
HEAD = """# Reliability

Made by `make torture`: everything here went wrong on purpose. *Refused clearly*: one line of at most 300 characters
with the reason, exit code 1 or 2. *Mended*: repaired or computed again, and said. *Right*: the result is what it is
without the fault. *Nobody can tell*: a changed number is a number, and a format without counts may end anywhere.
Files, requests and experiments have limits of time and memory.

"""


def main() -> None:
    """Run the groups that are named, all by default; end with 1 if anything is wrong or hung."""
    parser = argparse.ArgumentParser(prog="torture", description=__doc__)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"all by default: {', '.join(GROUPS)}")
    given = parser.parse_args()
    for unknown in set(given.groups) - set(GROUPS):
        parser.error(f"group {unknown!r} is unknown, choose from {', '.join(GROUPS)}")
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    bad = 0
    for group in given.groups or GROUPS:
        begin, found = time.monotonic(), []
        for ended in GROUPS[group]():
            found.append(ended)
            if ended.outcome in (WRONG, HUNG):
                bad += 1
                print(f"{ended.outcome}: {ended.kind}: {ended.name}: {ended.said}", flush=True)
        seconds = time.monotonic() - begin
        told = ", ".join(f"{count} {outcome}" for outcome, count in Counter(item.outcome for item in found).items())
        print(f"{group}: {len(found)} in {seconds:.0f} s: {told}", flush=True)
        FOLDER.mkdir(parents=True, exist_ok=True)
        kept = {"seconds": seconds, "cases": [asdict(item) for item in found]}
        (FOLDER / f"{group}.json").write_text(json.dumps(kept, indent=1))
    _write_page(PAGE)
    sys.exit(1 if bad else 0)


def _write_page(page: Path) -> None:
    """Write the table of what has been run, and say which groups have not."""
    missing = [group for group in GROUPS if not (FOLDER / f"{group}.json").exists()]
    rows, bad = [], []
    total: Counter[str] = Counter()
    for group in GROUPS:
        if group in missing:
            continue
        known = json.loads((FOLDER / f"{group}.json").read_text())
        cases = [Ended(**case) for case in known["cases"]]
        for kind in dict.fromkeys(case.kind for case in cases):
            counts = Counter(case.outcome for case in cases if case.kind == kind)
            total += counts
            rows.append(_row(f"{group}: {kind}", counts))
        bad += [case for case in cases if case.outcome in (WRONG, HUNG)]
    head = f"| kind of fault | tried | {' | '.join(OUTCOMES)} |\n|{'---|' * (len(OUTCOMES) + 2)}\n"
    listed = "".join(f"- {case.outcome}: {case.kind}, {case.name}: {case.said}\n" for case in bad)
    rest = f"\n## What is wrong\n\n{listed}" if bad else ""
    unknown = f"**Not run here: {', '.join(missing)}.**\n\n" if missing else ""
    page.write_text(HEAD + unknown + head + "".join(rows) + _row("**all**", total) + rest, encoding="utf-8")


def _row(name: str, counts: Counter[str]) -> str:
    cells = [name, str(counts.total()), *(str(counts[outcome]) for outcome in OUTCOMES)]
    return f"| {' | '.join(cells)} |\n"


if __name__ == "__main__":
    main()
