"""Faults drawn blind from the code of certificates alone: `python -m audits.mutation.blind_sample`.

A line is drawn if it can carry a fault and names a subject of certificates; eight subjects get equally many lines. Nothing
else enters: no list of lines, no weight, no seed tried before.
"""

from __future__ import annotations

import argparse
import json
import random
import re
from pathlib import Path
from typing import Any

from audits.mutation import ROOT
from audits.mutation.change import Change, source_of
from audits.mutation.import_graph import distances
from audits.mutation.places import changes
from audits.mutation.selection import measured_baseline, selected
from audits.mutation.trial import Outcome, Trial, prepare, run_all

# LDLT and Lanczos in `linalg` are counted by what `spectrum` asks of them
ROOMS = ("contract", "mesh", "operators", "io", "variational", "spectrum", "smoothing", "nulls", "skeleton", "embedding",
         "tasks", "report")  # fmt: skip
SUBJECTS = {
    "bounds": "bound|bounds|dual|lower_bound|upper_bound|error_bound",
    "gaps": "gap|relative_gap|labelling_gap|tolerance|converged|residual|residuals",
    "counts": "inertia|counts|complete|doubt|doubts|clusters|multiplicity",
    "verdicts": "",
    "areas": "area|areas|mass|weights",
    "masks": "mask|inside|isfinite|restrict|extend|part",
    "hemispheres": "hemisphere|hemispheres|hemi|structure",
    "units": "unit|scale|width",
}
# the rule of verdicts stands in files of its own, where every line belongs to it
RULE = re.compile(r"verdict|claim")
CONCERNED = 4
PROGRAMS = {"lab", "commands", "slurm", "tools", "test_plugins.py"}


def blind_sample(each: int, seed: int) -> list[tuple[str, Change]]:
    """Return `each` faults of every subject, fewer where it has fewer lines, in random order.

    Parameters
    ----------
    each : int
    seed : int

    Returns
    -------
    list of (str, Change)
        The subject and the fault; no line is drawn twice.
    """
    generator = random.Random(seed)
    lines: dict[tuple[str, int], list[Change]] = {}
    for room in ROOMS:
        for path in sorted((ROOT / "surfexp" / room).rglob("*.py")):
            name = path.relative_to(ROOT).as_posix()
            if room == "report" and not RULE.search(path.stem):
                continue
            for change in changes(name, source_of(path)):
                lines.setdefault((name, change.line), []).append(change)
    drawn: dict[tuple[str, int], tuple[str, Change]] = {}
    for subject, words in SUBJECTS.items():
        fitting = [place for place, those in lines.items() if place not in drawn and _names(those[0], words)]
        for place in generator.sample(fitting, min(each, len(fitting))):
            kind = generator.choice(sorted({change.kind for change in lines[place]}))
            drawn[place] = subject, generator.choice([change for change in lines[place] if change.kind == kind])
    chosen = list(drawn.values())
    generator.shuffle(chosen)
    return chosen


def _names(change: Change, words: str) -> bool:
    """Whether the line of a change names one of the words; without words, whether its file holds the rule of verdicts."""
    if not words:
        return RULE.search(Path(change.path).stem) is not None
    parts = re.findall(r"[A-Za-z_]\w*", change.texts[0])
    return any(re.fullmatch(words, part.strip("_")) for part in parts)


def concerned_tests(target: Path) -> list[Path]:
    """Return the four test files that reach a module by the fewest imports, those of its own room first."""
    files = [
        path
        for path in (ROOT / "tests").rglob("test_*.py")
        if path.relative_to(ROOT / "tests").parts[0] not in PROGRAMS
    ]
    room = target.relative_to(ROOT).parts[1]
    ranked = sorted(
        (distances(test)[target], test.parent.name != room, test)
        for test in sorted(files)
        if target in distances(test) and "browser" not in test.name
    )
    return [test for _, _, test in ranked[:CONCERNED]]


def main() -> None:
    """Try the drawn faults that the file of results does not hold, and print the share killed of each subject."""
    parser = argparse.ArgumentParser(prog="mutation.blind_sample", description=__doc__)
    parser.add_argument("--each", type=int, default=25, help="faults of a subject (default 25)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the sample (default 0)")
    parser.add_argument("--budget", type=float, default=15.0, help="seconds of tests for a fault (default 15)")
    parser.add_argument("--workers", type=int, default=1, help="faults tried at a time (default 1)")
    parser.add_argument("--survivors", type=Path, help="results of an earlier run, of which survivors are tried again")
    parser.add_argument("--tests", nargs="*", default=[], help="test files that concern every fault as well")
    parser.add_argument("--results", type=Path, default=ROOT / "results" / "mutation" / "blind.jsonl")
    options = parser.parse_args()
    sample = _again(_rows(options.survivors)) if options.survivors else blind_sample(options.each, options.seed)
    known = {row["identity"] for row in _rows(options.results)}
    wanted = {change: subject for subject, change in sample if change.identity not in known}
    if wanted:
        prepare()
        more = [ROOT / name for name in options.tests]

        def concerned(target: Path) -> list[Path]:
            reaching = [test for test in more if target in distances(test)]
            return list(dict.fromkeys([*concerned_tests(target), *reaching]))

        baseline = measured_baseline(wanted, options.workers, concerned)
        trials = [selected(change, baseline, options.budget, concerned) for change in wanted]
        for trial in (trial for trial in trials if not trial.arguments):
            _note(options.results, wanted, trial, Outcome("survived", (), {}, 0.0))
        for trial, outcome in run_all([trial for trial in trials if trial.arguments], options.workers):
            _note(options.results, wanted, trial, outcome)
    print(table(_rows(options.results)))


def _again(rows: list[dict[str, Any]]) -> list[tuple[str, Change]]:
    """The faults that survived, where their lines still stand."""
    alive = {(row["path"], row["old"], row["new"]): row["subject"] for row in rows if row["verdict"] == "survived"}
    found: dict[tuple[str, str, str], tuple[str, Change]] = {}
    for path in sorted({path for path, _, _ in alive}):
        for change in changes(path, source_of(ROOT / path)):
            key = (path, *change.texts)
            if key in alive:
                found.setdefault(key, (alive[key], change))
    return list(found.values())


def table(rows: list[dict[str, Any]]) -> str:
    """Return the share killed of each subject as a table of Markdown."""
    lines = ["| subject | faults | killed | share |", "|---|---|---|---|"]
    for subject in (*SUBJECTS, "all"):
        those = [row for row in rows if row["verdict"] != "broken" and subject in (row["subject"], "all")]
        killed = sum(row["verdict"] != "survived" for row in those)
        lines.append(f"| {subject} | {len(those)} | {killed} | {killed / max(len(those), 1):.0%} |")
    return "\n".join(lines)


def _rows(path: Path) -> list[dict[str, Any]]:
    return [json.loads(row) for row in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []


def _note(path: Path, subjects: dict[Change, str], trial: Trial, outcome: Outcome) -> None:
    """Append a result to the file, and print it."""
    assert trial.change is not None
    change, (old, new) = trial.change, trial.change.texts
    row = {
        "identity": change.identity,
        "subject": subjects[change],
        "path": change.path,
        "line": change.line,
        "old": old,
    }
    row |= {"new": new, "verdict": outcome.verdict, "tests": len(trial.seconds), "cpu": round(outcome.cpu, 1)}
    row |= {"failed": outcome.failed[:1]}
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")
    print(
        f"{outcome.verdict:9} {outcome.cpu:5.1f} s  {change.path} line {change.line}\n    {old}\n    {new}", flush=True
    )


if __name__ == "__main__":
    main()
