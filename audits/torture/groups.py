"""What goes wrong, in groups: each is run in processes of its own, told, and kept for docs/reliability.md."""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import asdict
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from audits.torture import ROOT
from audits.torture.bad_files import bad_files
from audits.torture.case import HUNG, OUTCOMES, WRONG, Ended
from audits.torture.damages import damages
from audits.torture.kills import drivers, kills
from audits.torture.misdeeds import misdeeds
from audits.torture.names import names
from audits.torture.requests import requests
from audits.torture.strangers import strangers

# each group in parts that may run side by side; cases with short limits first, crowds of processes last
GROUPS: dict[str, list[Callable[[], Iterator[Ended]]]] = {
    "files": [bad_files],
    "damages": [damages],
    "requests": [requests],
    "misdeeds": [misdeeds],
    "strangers": [strangers],
    "names": [names],
    "kills": [partial(kills, seed, 25) for seed in range(8)],
    "drivers": [partial(drivers, 5) for _ in range(4)],
}
# minutes: a part of each group but what takes a crowd of processes, each time the same
PART: dict[str, list[Callable[[], Iterator[Ended]]]] = {
    "files": [partial(bad_files, every=13)],
    "damages": [partial(damages, 0, 20, whole_runs=4)],
    "requests": [partial(requests, 0, 20)],
    "misdeeds": [partial(misdeeds, every=8)],
    "strangers": [partial(strangers, every=8)],
    "names": [partial(names, every=8)],
    "kills": [partial(kills, 0, 4)],
}
AT_ONCE = 2
Part = tuple[float, list[Ended]]
PAGE = ROOT / "docs" / "reliability.md"
FOLDER = ROOT / "results" / "torture"
HEAD = """# Reliability

Made by `make torture`: everything here went wrong on purpose. *Refused clearly*: one line of at most 300 characters
with the reason, exit code 1 or 2. *Repaired*: repaired or computed again, with a line that says so. *Right*: the result
equals that without the fault. *Nobody can tell*: a changed number is a number, and a format without counts may end
anywhere. Files, requests and experiments have limits of time and memory.

"""


def main() -> None:
    """Run the groups that are named, all by default; end with 1 if anything is wrong or hung."""
    parser = argparse.ArgumentParser(prog="torture", description=main.__doc__)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"all by default: {', '.join(GROUPS)}")
    parser.add_argument("--part", action="store_true", help="one case of many, in minutes; the page is left as it is")
    given = parser.parse_args()
    for unknown in set(given.groups) - set(GROUPS):
        parser.error(f"group {unknown!r} is unknown, choose from {', '.join(GROUPS)}")
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    groups = PART if given.part else GROUPS
    bad = _run({name: groups[name] for name in given.groups or groups}, keep=not given.part)
    if not given.part:
        _write_page(PAGE)
    sys.exit(1 if bad else 0)


def _run(groups: dict[str, list[Callable[[], Iterator[Ended]]]], keep: bool) -> int:
    """Run the parts of the groups, some at once and each in a new process; keep a group as soon as it is whole."""
    bad = 0
    with ProcessPoolExecutor(AT_ONCE, get_context("spawn"), max_tasks_per_child=1) as pool:
        parts: dict[Future[Part], str] = {
            pool.submit(_part, work): group for group, works in groups.items() for work in works
        }
        done: dict[str, list[Part]] = {group: [] for group in groups}
        for future in as_completed(parts):
            group = parts[future]
            done[group].append(future.result())
            if len(done[group]) == len(groups[group]):
                bad += _told(group, done[group], keep)
    return bad


def _part(work: Callable[[], Iterator[Ended]]) -> Part:
    begin = time.monotonic()
    found = []
    for ended in work():
        found.append(ended)
        if ended.outcome in (WRONG, HUNG):
            print(f"{ended.outcome}: {ended.kind}: {ended.name}: {ended.said}", flush=True)
    return time.monotonic() - begin, found


def _told(group: str, parts: list[Part], keep: bool) -> int:
    """Print what came of a group, and store it if it is kept; return how many cases are wrong or hung."""
    seconds = sum(spent for spent, _ in parts)
    found = [ended for _, cases in parts for ended in cases]
    counts = Counter(ended.outcome for ended in found)
    told = ", ".join(f"{count} {outcome}" for outcome, count in counts.items())
    print(f"{group}: {len(found)} in {seconds:.0f} s: {told}", flush=True)
    if keep:
        FOLDER.mkdir(parents=True, exist_ok=True)
        kept = {"seconds": seconds, "cases": [asdict(item) for item in found]}
        (FOLDER / f"{group}.json").write_text(json.dumps(kept, indent=1))
    return counts[WRONG] + counts[HUNG]


def _write_page(page: Path) -> None:
    """Write the table of what has been run, and say which groups have not."""
    missing = [group for group in GROUPS if not (FOLDER / f"{group}.json").exists()]
    rows, bad, took = [], [], {}
    total: Counter[str] = Counter()
    for group in GROUPS:
        if group in missing:
            continue
        known = json.loads((FOLDER / f"{group}.json").read_text())
        cases = [Ended(**case) for case in known["cases"]]
        took[group] = known["seconds"] / 60.0
        for kind in dict.fromkeys(case.kind for case in cases):
            counts = Counter(case.outcome for case in cases if case.kind == kind)
            total += counts
            rows.append(_row(f"{group}: {kind}", counts))
        bad += [case for case in cases if case.outcome in (WRONG, HUNG)]
    head = f"| kind of fault | tried | {' | '.join(OUTCOMES)} |\n|{'---|' * (len(OUTCOMES) + 2)}\n"
    listed = "".join(f"- {case.outcome}: {case.kind}, {case.name}: {case.said}\n" for case in bad)
    rest = f"\n## What is wrong\n\n{listed}" if bad else ""
    times = ", ".join(f"{group} {minutes:.1f}" for group, minutes in took.items())
    told = f"\nMinutes, {AT_ONCE} parts side by side: {times}; all {sum(took.values()) / AT_ONCE:.0f}.\n"
    unknown = f"**Not run here: {', '.join(missing)}.**\n\n" if missing else ""
    # sections of others stay as they are
    kept = page.read_text(encoding="utf-8").partition("\n## Files that ") if page.exists() else ("", "", "")
    text = HEAD + unknown + head + "".join(rows) + _row("**all**", total) + told + rest
    page.write_text(text + "".join(kept[1:]), encoding="utf-8")


def _row(name: str, counts: Counter[str]) -> str:
    cells = [name, str(counts.total()), *(str(counts[outcome]) for outcome in OUTCOMES)]
    return f"| {' | '.join(cells)} |\n"
