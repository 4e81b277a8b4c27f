"""Faults that have to turn a claim: each is planted in a copy of the code, its experiment is run and judged again."""

from __future__ import annotations

import ast
import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path

import yaml

from audits.mutation import ROOT
from surfexp.reproduction.page import sections_of, verdicts_of_section
from surfexp.reproduction.pages import read_pages
from surfexp.reproduction.stamp import PAGES, is_stale

LIST = ROOT / "audits" / "mutation" / "claims.yaml"
RESULTS = ROOT / "results" / "mutation" / "claims"
LIMIT = 5400  # seconds for an experiment with a fault; one that takes longer says nothing
PARTS = {
    "surfexp": "surfexp",
    "studies": "surfexp_studies",
    "plugins": "surfexp/plugins",
    "conf": "surfexp/conf",
    "profiles": "surfexp/profiles",
}
JUDGE = """
import json, sys
from pathlib import Path
from surfexp.lab.plan.plan import latest_plan
from surfexp.lab.experiment.claim import read_claims
from surfexp.records.table import rows_of
from surfexp.report.verdict import judge
results = Path(sys.argv[1])
plan = latest_plan(results, sys.argv[2])
found = judge(read_claims(plan.settings.claims), rows_of(plan, results))
print(json.dumps({item.claim.claim: [item.verdict, item.number, item.why] for item in found}))
"""


Verdicts = dict[str, list[str]]
OTHER_MACHINE = "kinds of machine do not compare"
OUTCOMES = ("turned", "stopped", "untouched", "not computed")


@dataclass(frozen=True)
class ClaimFault:
    """One exact replacement in one file for one experiment, and the claim that it has to turn.

    Parameters
    ----------
    experiment : str
    path : str
        Below the root of the checkout.
    old, new : str
        `old` occurs exactly once.
    claim : str
        How the claim begins; empty where any claim of the experiment will do.
    """

    experiment: str
    path: str
    old: str
    new: str
    claim: str = ""

    @property
    def change(self) -> tuple[str, str, str]:
        """The replacement: claims that one fault has to turn share one run."""
        return self.path, self.old, self.new

    @cached_property
    def identity(self) -> str:
        """Digest of the replacement and of the code of the file in which it is planted, whatever its comments say."""
        code = ast.dump(ast.parse((ROOT / self.path).read_text(encoding="utf-8")))
        parts = [self.experiment, *self.change, code]
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:12]


@dataclass(frozen=True)
class Trial:
    """The verdicts of an experiment without a fault and with it."""

    fault: ClaimFault
    before: Verdicts
    after: Verdicts

    def outcome(self, claim: str) -> str:
        """Return what the fault did to a claim, one of OUTCOMES."""
        before, (after, *said) = self.before[claim][0], self.of(claim)
        if any(
            OTHER_MACHINE in text for text in said
        ):  # stored stages were timed elsewhere: nothing that the fault did
            return "untouched"
        if "not computed" in (before, after):
            return "not computed" if before == after or before == "not computed" else "stopped"
        return "untouched" if before == after else "turned"

    def of(self, claim: str) -> list[str]:
        """Return verdict, number and reason with the fault."""
        return self.after.get(claim, ["not computed", "–", "the run ended"])

    @property
    def named(self) -> str:
        """The claim that the fault has to turn, empty if it names none."""
        return next((claim for claim in self.before if self.fault.claim and claim.startswith(self.fault.claim)), "")


def faults(words: Sequence[str] = ()) -> list[ClaimFault]:
    """The listed faults, or those of experiments with one of the words in their name."""
    every = [ClaimFault(**entry) for entry in yaml.safe_load(LIST.read_text(encoding="utf-8"))["faults"]]
    return [fault for fault in every if not words or any(word in fault.experiment for word in words)]


def recorded_trials() -> list[Trial]:
    """The trials of all listed faults that are recorded here."""
    return [Trial(fault, **known) for fault in faults() if (known := _recorded(fault.experiment).get(fault.identity))]


def reproduced_verdicts(wanted: Sequence[ClaimFault]) -> dict[str, Verdicts]:
    """The verdicts without a fault that the page of published claims holds of the present stages, by experiment."""
    page = read_pages(ROOT / PAGES)
    sections = sections_of(page)
    names = sorted({fault.experiment for fault in wanted})
    return {name: verdicts_of_section(sections[name]) for name in names if not is_stale(name, page)}


def try_all(
    wanted: Sequence[ClaimFault],
    workers: int,
    known_before: Mapping[str, Verdicts] | None = None,
    stages: Path | None = None,
) -> Iterator[Trial]:
    """Run what has no record yet and give the trials of all, an experiment at a time.

    Verdicts without a fault are those of `known_before`, or else of a run. Stages that the fault does not reach are taken
    from `stages`, a folder of results.
    """
    before = known_before or {}
    by_experiment: dict[str, list[ClaimFault]] = {}
    for fault in wanted:
        by_experiment.setdefault(fault.experiment, []).append(fault)

    def tried(experiment: str) -> list[Trial]:
        return _try(experiment, by_experiment[experiment], before.get(experiment), stages)

    with ThreadPoolExecutor(workers) as pool:
        yield from chain.from_iterable(pool.map(tried, by_experiment))


def _try(experiment: str, wanted: list[ClaimFault], before: Verdicts | None, stages: Path | None) -> list[Trial]:
    shutil.rmtree(RESULTS / experiment / "code", ignore_errors=True)
    if stages is not None:
        _begin_with(stages, RESULTS / experiment)
    known = _recorded(experiment)
    missing = {fault.identity: fault for fault in wanted if fault.identity not in known}
    sound = before or (_verdicts(experiment, None) if missing else {})
    for identity, fault in missing.items():
        try:
            known[identity] = {"before": sound, "after": _verdicts(experiment, fault)}
        except subprocess.TimeoutExpired:
            print(f"{experiment}: {fault.path}: not run, for it took more than {LIMIT} s", flush=True)
            continue
        RESULTS.mkdir(parents=True, exist_ok=True)
        _record(experiment).write_text(json.dumps(known, indent=1), encoding="utf-8")
    return [Trial(fault, **known[fault.identity]) for fault in wanted if fault.identity in known]


def _begin_with(stages: Path, folder: Path) -> None:
    """Link the stored stages of a folder of results into another, unless it holds some; a stored file is never written to."""
    if not (folder / "store").exists():
        shutil.copytree(stages / "store", folder / "store", copy_function=os.link)
        shutil.copytree(stages / "events", folder / "events", dirs_exist_ok=True)


def _record(experiment: str) -> Path:
    return RESULTS / f"{experiment}.json"


def _recorded(experiment: str) -> dict[str, dict[str, Verdicts]]:
    record = _record(experiment)
    return json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}


def _verdicts(experiment: str, fault: ClaimFault | None) -> Verdicts:
    """Run an experiment without figures on a copy of the code, with a fault in it where one is given; judge its claims."""
    folder = RESULTS / experiment
    # always the same place: what Python and numba have compiled is found by the path of its source
    copy = folder / "code"
    for source, target in PARTS.items():
        shutil.copytree(ROOT / source, copy / target, ignore=shutil.ignore_patterns("__pycache__"), dirs_exist_ok=True)
    if fault is not None:
        _plant(fault, copy)
    environment = {**os.environ, "PYTHONPATH": str(copy)}

    def python(*arguments: str) -> str:
        command = [sys.executable, *arguments]
        return subprocess.run(
            command, cwd=copy, env=environment, capture_output=True, text=True, check=False, timeout=LIMIT
        ).stdout

    options = [f"experiment={experiment}", f"results={folder}", "cores=1", "figures=[]"]
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
