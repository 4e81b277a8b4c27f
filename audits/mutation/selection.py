"""The tests most likely to catch a fault first: near by import and quick."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from audits.mutation import ROOT
from audits.mutation.change import Change, source_of
from audits.mutation.import_graph import distances, numeric_tests
from audits.mutation.trial import Trial, run_all

BASELINE = ROOT / "results" / "mutation" / "baseline.json"
# a test so slow is left to the suite; a test one import farther away is taken as a third as likely to notice
SLOW, FARTHER, LEAST = 15.0, 3.0, 0.02
NEAREST = 8
Baseline = dict[str, dict[str, Any]]


def measured_baseline(
    changes: Iterable[Change], workers: int, tests_of: Callable[[Path], list[Path]] | None = None
) -> Baseline:
    """Return what the test files nearest to one of the changes do without a fault, run where it is not known.

    A file is run again when it or anything that it imports has changed. Tests that fail without a fault prove nothing
    and are left out.
    """
    targets = {ROOT / change.path for change in changes}
    baseline: Baseline = json.loads(BASELINE.read_text()) if BASELINE.exists() else {}
    files = {_name(test): _digest(test) for target in sorted(targets) for test in (tests_of or nearest_tests)(target)}
    unknown = [name for name, digest in files.items() if baseline.get(name, {}).get("digest") != digest]
    for trial, outcome in run_all((Trial((name,)) for name in unknown), workers):
        name = trial.arguments[0]
        baseline[name] = {"digest": files[name], "seconds": outcome.seconds, "failed": outcome.failed}
        BASELINE.parent.mkdir(parents=True, exist_ok=True)
        BASELINE.write_text(json.dumps(baseline, indent=1))
        state = f"{outcome.verdict} {'; '.join(outcome.failed)}" if outcome.failed else "passes"
        print(f"{outcome.cpu:6.1f} s  {name}: {len(outcome.seconds)} tests, {state}", flush=True)
    return {name: baseline[name] for name in files}


def selected(
    change: Change, baseline: Baseline, budget: float, tests_of: Callable[[Path], list[Path]] | None = None
) -> Trial:
    """Return the trial of a fault: tests in order of their seconds, tripled with each import, until the budget is spent."""
    target, candidates = ROOT / change.path, []
    for file in (tests_of or nearest_tests)(target):
        name, distance = _name(file), distances(file)[target]
        entry = baseline.get(name, {"seconds": {}, "failed": []})
        for test, seconds in entry["seconds"].items():
            if seconds <= SLOW and not any(row.startswith(test) for row in entry["failed"]):
                score = math.log2(max(seconds, LEAST) * FARTHER**distance)
                # tests of one file that are about as likely stay together, for the sake of their fixtures
                candidates.append((round(score), name, seconds, test))
    kept: dict[str, float] = {}
    for _, _, seconds, test in sorted(candidates):
        if kept and sum(kept.values()) + seconds > budget:
            break
        kept[test] = seconds
    return Trial(tuple(dict.fromkeys(test.split("::")[0] for test in kept)), change, kept)


def nearest_tests(target: Path) -> list[Path]:
    """Return the eight test files that reach a module by the fewest imports, those of its own package first."""
    package = target.relative_to(ROOT).parts[1]
    ranked = sorted(
        (distances(test)[target], test.parent.name != package, test)
        for test in numeric_tests()
        if target in distances(test)
    )
    return [test for _, _, test in ranked[:NEAREST]]


def _name(test: Path) -> str:
    return test.relative_to(ROOT).as_posix()


def _digest(test: Path) -> str:
    state = hashlib.sha256()
    for path in sorted(distances(test)):
        state.update(path.relative_to(ROOT).as_posix().encode() + source_of(path))
    return state.hexdigest()[:20]
