"""Faults that have to turn a claim: each is planted in a copy of the code, its experiment is run and judged again."""

from __future__ import annotations

import ast
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

import yaml

from mutation import ROOT

LIST = ROOT / "mutation" / "claims.yaml"
RESULTS = ROOT / "results" / "mutation" / "claims"
LIMIT = 5400  # seconds for an experiment with a fault; one that takes longer says nothing
PAGE = ROOT / "docs" / "claim_faults.md"
HEAD = """# Claims that faults turn

Made by `python -m mutation claims`. A claim that no fault in the code can turn says nothing. Each fault is planted in
a copy of the code, its experiment is run again, and all its claims are judged again. *Turned*: the verdict is another
one, by a number. *Stopped*: a certificate, a check or an error left the claim not computed. *Untouched*: no fault that
was run changed the verdict. Of several faults the table shows the one that names the claim in `mutation/claims.yaml`,
or else the first that turned it. *Not run*: readings of a collection that has to be brought (TOSCA), and faults that have
not been run yet.

**{summary}** {faults} faults were run, {missing} not.

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


Verdicts = dict[str, list[str]]
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
        before, after = self.before[claim][0], self.of(claim)[0]
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


def try_all(wanted: Sequence[ClaimFault], workers: int) -> Iterator[Trial]:
    """Run what has no record yet and give the trials of all, an experiment at a time."""
    by_experiment: dict[str, list[ClaimFault]] = {}
    for fault in wanted:
        by_experiment.setdefault(fault.experiment, []).append(fault)
    with ThreadPoolExecutor(workers) as pool:
        yield from chain.from_iterable(pool.map(_try, by_experiment, by_experiment.values()))


def _try(experiment: str, wanted: list[ClaimFault]) -> list[Trial]:
    known = _recorded(experiment)
    missing = {fault.identity: fault for fault in wanted if fault.identity not in known}
    sound = _verdicts(experiment, None) if missing else {}
    for identity, fault in missing.items():
        try:
            known[identity] = {"before": sound, "after": _verdicts(experiment, fault)}
        except subprocess.TimeoutExpired:
            print(f"{experiment}: {fault.path}: not run, for it took more than {LIMIT} s", flush=True)
            continue
        RESULTS.mkdir(parents=True, exist_ok=True)
        _record(experiment).write_text(json.dumps(known, indent=1), encoding="utf-8")
    return [Trial(fault, **known[fault.identity]) for fault in wanted if fault.identity in known]


def _record(experiment: str) -> Path:
    return RESULTS / f"{experiment}.json"


def _recorded(experiment: str) -> dict[str, dict[str, Verdicts]]:
    record = _record(experiment)
    return json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}


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
            return subprocess.run(
                command, cwd=copy, env=environment, capture_output=True, text=True, check=False, timeout=LIMIT
            ).stdout

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
    """Write the table of all claims of experiments that have a trial."""
    every = faults()
    trials = [Trial(fault, **known) for fault in every if (known := _recorded(fault.experiment).get(fault.identity))]
    rows = [_row(name, claim, trials) for name, claim in _stated()]
    counts = Counter(outcome for outcome, _ in rows)
    summary = f"Of {len(rows)} claims {counts['turned']} turned, {counts['stopped']} stopped, "
    summary += f"{counts['untouched']} untouched, {counts['not computed']} not computed without a fault, "
    summary += f"{counts['not run']} not run."
    missing = len({(fault.experiment, fault.change) for fault in every}) - len(
        run := {(trial.fault.experiment, trial.fault.change) for trial in trials}
    )
    head = HEAD.format(summary=summary, faults=len(run), missing=missing)
    PAGE.write_text(head + "".join(line for _, line in rows), encoding="utf-8")


def _stated() -> list[tuple[str, str]]:
    """Return (experiment, claim) of every claim."""
    files = sorted((ROOT / "conf" / "experiment").glob("*.yaml"))
    stated = [(file.stem, yaml.safe_load(file.read_text(encoding="utf-8")).get("claims") or []) for file in files]
    return [(name, entry["claim"]) for name, entries in stated for entry in entries]


def _row(name: str, claim: str, trials: list[Trial]) -> tuple[str, str]:
    """Return outcome and line of a claim, from the trial that says most about it."""
    own = [trial for trial in trials if trial.fault.experiment == name and claim in trial.before]
    if not own:
        return "not run", _line(name, claim, "–", "–", "–", "not run")
    best = min(own, key=lambda trial: (OUTCOMES.index(trial.outcome(claim)), trial.named != claim))
    outcome = best.outcome(claim)
    before = " ".join(best.before[claim][:2])
    if outcome not in ("turned", "stopped"):
        count = len({trial.fault.change for trial in own})
        return outcome, _line(name, claim, f"{count} fault{'s' if count > 1 else ''}", before, before, outcome)
    fault = best.fault
    change = f"{fault.path}: `{_code(fault.old)}` → `{_code(fault.new)}`"
    return outcome, _line(name, claim, change, before, " ".join(best.of(claim)[:2]), outcome)


def _line(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _code(text: str) -> str:
    return " ".join(text.split())
