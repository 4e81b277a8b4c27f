"""Faults that have to turn a claim: each is planted in a copy of the code, and the experiment is run and judged again."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

import yaml

from mutation import ROOT

LIST = ROOT / "mutation" / "claims.yaml"
RESULTS = ROOT / "results" / "mutation" / "claims"
PAGE = ROOT / "docs" / "claim_faults.md"
HEAD = """# Claims that faults turn

Made by `python -m mutation claims`. A claim that no fault in the code can turn says nothing. Each fault below is planted in
a copy of the code, its experiment is run and judged again. *Turned*: the verdict is another one, by a number. *Stopped*: a
certificate, a check or an error left the claim not computed. *Untouched*: the verdict is the same.

**{summary}** {without} of {stated} claims have no fault listed here.

| experiment | claim | fault | without it | with it | outcome |
|---|---|---|---|---|---|
"""
PARTS = {"surfexp": "surfexp", "plugins": "surfexp/plugins", "conf": "surfexp/conf", "profiles": "surfexp/profiles"}
JUDGE = """
import json, sys
from pathlib import Path
from surfexp.commands.views import latest_plan
from surfexp.report.claim import read_claims
from surfexp.report.table import rows_of
from surfexp.report.verdict import judge
results = Path(sys.argv[1])
plan = latest_plan(results, sys.argv[2])
found = judge(read_claims(plan.settings.claims), rows_of(plan, results))
print(json.dumps({item.claim.claim: [item.verdict, item.number, item.why] for item in found}))
"""


@dataclass(frozen=True)
class ClaimFault:
    """One exact replacement in one file, and the claim that it has to turn.

    Parameters
    ----------
    experiment : str
    claim : str
        How the claim begins.
    path : str
        Below the root of the checkout.
    old, new : str
        `old` occurs exactly once.
    """

    experiment: str
    claim: str
    path: str
    old: str
    new: str

    @property
    def change(self) -> tuple[str, str, str]:
        """The replacement: claims that one fault has to turn share one run."""
        return self.path, self.old, self.new

    @cached_property
    def identity(self) -> str:
        """Digest of the fault and of the file in which it is planted."""
        parts = [self.experiment, self.claim, *self.change, (ROOT / self.path).read_text(encoding="utf-8")]
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:12]


Verdicts = dict[str, list[str]]


def faults(words: Sequence[str] = ()) -> list[ClaimFault]:
    """The listed faults, or those of experiments with one of the words in their name."""
    every = [ClaimFault(**entry) for entry in yaml.safe_load(LIST.read_text(encoding="utf-8"))["faults"]]
    return [fault for fault in every if not words or any(word in fault.experiment for word in words)]


def try_all(wanted: Sequence[ClaimFault], workers: int) -> Iterator[dict[str, Any]]:
    """Run what has no record yet and give the records of all, an experiment at a time."""
    by_experiment: dict[str, list[ClaimFault]] = {}
    for fault in wanted:
        by_experiment.setdefault(fault.experiment, []).append(fault)
    with ThreadPoolExecutor(workers) as pool:
        yield from chain.from_iterable(pool.map(_try, by_experiment, by_experiment.values()))


def _try(experiment: str, wanted: list[ClaimFault]) -> list[dict[str, Any]]:
    record = RESULTS / f"{experiment}.json"
    known = json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}
    found = {fault.identity: known[fault.identity] for fault in wanted if fault.identity in known}
    missing = [fault for fault in wanted if fault.identity not in found]
    if missing:
        sound = _verdicts(experiment, None)
    changes = {fault.change: fault for fault in missing}
    for change, first in changes.items():
        faulty = _verdicts(experiment, first)
        for fault in (fault for fault in missing if fault.change == change):
            found[fault.identity] = _compared(fault, sound, faulty)
        record.parent.mkdir(parents=True, exist_ok=True)
        record.write_text(json.dumps(known | found, indent=1), encoding="utf-8")
    return [found[fault.identity] for fault in wanted]


def _compared(fault: ClaimFault, sound: Verdicts, faulty: Verdicts) -> dict[str, Any]:
    """A claim turned by a number, or stopped because the fault left it without one, or untouched by the fault."""
    claim = next(claim for claim in sound if claim.startswith(fault.claim))
    before, after = sound[claim], faulty.get(claim, ["not computed", "–", "the run ended"])
    outcome = "turned" if after[0] != before[0] else "untouched"
    if outcome == "turned" and after[0] == "not computed":
        outcome = "stopped"
    row = {"experiment": fault.experiment, "claim": claim, "path": fault.path, "old": fault.old, "new": fault.new}
    return row | {"outcome": outcome, "before": before, "after": after}


def _verdicts(experiment: str, fault: ClaimFault | None) -> Verdicts:
    """Run an experiment on a copy of the code, with a fault in it where one is given, and judge its claims."""
    folder = RESULTS / experiment
    with tempfile.TemporaryDirectory() as copy:
        for source, target in PARTS.items():
            shutil.copytree(ROOT / source, Path(copy) / target, ignore=shutil.ignore_patterns("__pycache__"))
        if fault is not None:
            _plant(fault, Path(copy))
        environment = {**os.environ, "PYTHONPATH": copy}

        def python(*arguments: str) -> str:
            command = [sys.executable, *arguments]
            done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
            return done.stdout

        options = [f"experiment={experiment}", f"results={folder}", "cores=1"]
        python("-m", "surfexp.commands.command_line", "run", *options)
        answer = python("-c", JUDGE, str(folder), experiment).strip()
    return json.loads(answer.splitlines()[-1]) if answer else {}


def _plant(fault: ClaimFault, copy: Path) -> None:
    room, rest = fault.path.split("/", 1)
    file = copy / PARTS[room] / rest
    source = file.read_text(encoding="utf-8")
    if source.count(fault.old) != 1:
        raise ValueError(f"{fault.old!r} occurs {source.count(fault.old)} times in {fault.path}, not once")
    file.write_text(source.replace(fault.old, fault.new), encoding="utf-8")


def write_page() -> None:
    """Write the table of all listed faults that have a record."""
    rows = []
    for fault in faults():
        record = RESULTS / f"{fault.experiment}.json"
        known = json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}
        rows += [known[fault.identity]] if fault.identity in known else []
    counts = Counter(row["outcome"] for row in rows)
    summary = ", ".join(f"{counts[outcome]} {outcome}" for outcome in ("turned", "stopped", "untouched"))
    stated = sum(len(_claims_of(file)) for file in (ROOT / "conf" / "experiment").glob("*.yaml"))
    named = {(row["experiment"], row["claim"]) for row in rows}
    head = HEAD.format(
        summary=f"{summary}; {len(faults()) - len(rows)} not run.", without=stated - len(named), stated=stated
    )
    PAGE.write_text(head + "".join(map(_line, rows)), encoding="utf-8")


def _claims_of(file: Path) -> list[Any]:
    return yaml.safe_load(file.read_text(encoding="utf-8")).get("claims") or []


def _line(row: dict[str, Any]) -> str:
    change = f"{row['path']}: `{_code(row['old'])}` → `{_code(row['new'])}`"
    before, after = (" ".join(row[side][:2]) for side in ("before", "after"))
    cells = (row["experiment"], row["claim"], change, before, after, row["outcome"])
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _code(text: str) -> str:
    return " ".join(text.split())
