"""Plant faults one by one: `python -m audits.mutation planted` and `random` run tests, `claims` runs experiments."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from itertools import chain
from pathlib import Path

from audits.mutation import claims, claims_page
from audits.mutation.change import Change
from audits.mutation.fault import Fault
from audits.mutation.geometry_faults import GEOMETRY_FAULTS
from audits.mutation.operator_faults import OPERATOR_FAULTS
from audits.mutation.record import PAGE, add, explanations, page, results
from audits.mutation.sample import sample
from audits.mutation.selection import measured_baseline, selected
from audits.mutation.trial import Outcome, Trial, prepare, run_all
from audits.mutation.variational_faults import VARIATIONAL_FAULTS

FAULTS = OPERATOR_FAULTS + VARIATIONAL_FAULTS + GEOMETRY_FAULTS


def main() -> None:
    """Run what is asked for; end with 1 if a planted fault survives or a random one cannot be tried."""
    parser = argparse.ArgumentParser(prog="mutation", description=__doc__)
    commands = parser.add_subparsers(required=True)
    planted = commands.add_parser("planted", help="faults chosen by hand, each with the tests that have to catch it")
    planted.add_argument("words", nargs="*", metavar="WORD", help="part of the name of a fault")
    planted.set_defaults(run=run_planted)
    drawn = commands.add_parser("random", help="a sample over all numerics; what is recorded is not run again")
    drawn.add_argument("--count", type=int, default=300, help="faults (default 300)")
    drawn.add_argument("--seed", type=int, default=0, help="seed of the sample (default 0)")
    drawn.add_argument("--budget", type=float, default=30.0, help="seconds of tests for a fault (default 30)")
    drawn.add_argument("--only", default="", metavar="WORD", help="faults of files with WORD in their path")
    drawn.add_argument("--survivors", action="store_true", help="try those again that survived before unexplained")
    drawn.add_argument("--page", type=Path, default=PAGE, help="where the page is written")
    drawn.set_defaults(run=run_random)
    turning = commands.add_parser("claims", help="faults that have to turn a claim; what is recorded is not run again")
    turning.add_argument("words", nargs="*", metavar="WORD", help="part of the name of an experiment")
    turning.add_argument("--open", action="store_true", help="only those that name a claim which is not turned yet")
    turning.add_argument(
        "--reproduced",
        action="store_true",
        help="verdicts without a fault are those of docs/reproduction.md where true",
    )
    turning.add_argument(
        "--stages", type=Path, metavar="RESULTS", help="take stages that a fault does not reach from here"
    )
    turning.set_defaults(run=run_claims)
    for command in (planted, drawn, turning):
        command.add_argument("--workers", type=int, default=1, help="faults tried at a time (default 1)")
    options = parser.parse_args()
    problems = options.run(options)
    print("\n".join(problems))
    sys.exit(1 if problems else 0)


def run_planted(options: argparse.Namespace) -> list[str]:
    """Return which of the faults chosen by hand were not caught."""
    faults = [fault for fault in FAULTS if not options.words or any(word in fault.name for word in options.words)]
    if not faults:
        words = " or ".join(map(repr, options.words))
        return [f"no fault has {words} in its name, the first is {FAULTS[0].name!r}"]
    prepare()
    tests = sorted({test for fault in faults for test in fault.tests})
    baseline = run_all([Trial((test,)) for test in tests], options.workers)
    red = {trial.arguments[0]: outcome.failed[0] for trial, outcome in baseline if outcome.failed}
    names: dict[Change, Fault] = {}
    problems = []
    for fault in faults:
        if not_passing := [red[test] for test in fault.tests if test in red]:
            problems.append(f"{fault.name}: a test does not pass without the fault: {not_passing[0]}")
            continue
        try:
            names[fault.change] = fault
        except (ValueError, OSError) as error:
            problems.append(str(error))
    trials = [Trial(fault.tests, change) for change, fault in names.items()]
    for trial, outcome in run_all(trials, options.workers):
        assert trial.change is not None
        fault = names[trial.change]
        _report(fault.name, trial.change, outcome)
        if outcome.verdict in ("survived", "broken"):
            problems.append(f"{outcome.verdict}: {fault.name} ({fault.path})")
    return problems


def run_random(options: argparse.Namespace) -> list[str]:
    """Try the faults of the sample that have no result, write the page, and return those that could not be tried."""
    changes = sample(options.count, options.seed)
    known = results()
    state = "survived" if options.survivors else ""
    verdicts = {change: known.get(change.identity, {}).get("verdict", "") for change in changes}
    settled = explanations() if options.survivors else {}
    wanted = [change for change in changes if options.only in change.path and verdicts[change] == state]
    wanted = [change for change in wanted if (change.path, *change.texts) not in settled]
    problems = []
    if wanted:
        prepare()
        baseline = measured_baseline(wanted, options.workers)
        trials = [selected(change, baseline, options.budget) for change in wanted]
        untested = [(trial, Outcome("survived", (), {}, 0.0)) for trial in trials if not trial.arguments]
        tried = run_all([trial for trial in trials if trial.arguments], options.workers)
        for number, (trial, outcome) in enumerate(chain(untested, tried), 1):
            assert trial.change is not None
            _report(f"{number} of {len(wanted)}", trial.change, outcome)
            if outcome.verdict == "broken":
                problems.append(f"broken: {trial.change.path} line {trial.change.line}: {' '.join(outcome.failed)}")
            else:
                add(trial.change, outcome)
    options.page.write_text(page(changes, results(), options.seed, options.budget), encoding="utf-8")
    return problems


def run_claims(options: argparse.Namespace) -> list[str]:
    """Return which claims their fault left untouched, and write the page of all that are recorded."""
    problems = []
    wanted = claims_page.open_faults(options.words) if options.open else claims.faults(options.words)
    before = claims.reproduced_verdicts(wanted) if options.reproduced else {}
    for trial in claims.try_all(wanted, options.workers, before, options.stages):
        counts = Counter(trial.outcome(claim) for claim in trial.before)
        told = ", ".join(f"{counts[outcome]} {outcome}" for outcome in claims.OUTCOMES if counts[outcome])
        print(f"{trial.fault.experiment}: {trial.fault.path}: {told}", flush=True)
        if trial.named and trial.outcome(trial.named) == "untouched":
            problems.append(f"untouched: {trial.fault.experiment}: {trial.named}")
    claims_page.write_page()
    return problems


def _report(name: str, change: Change, outcome: Outcome) -> None:
    old, new = change.texts
    print(f"{outcome.verdict:9} {outcome.cpu:6.1f} s  {name}, {change.path} line {change.line}\n    {old}\n    {new}")
    print("".join(f"    {row}\n" for row in outcome.failed[:1]), end="", flush=True)


if __name__ == "__main__":
    main()
