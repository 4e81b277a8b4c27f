"""What became of the faults: a file of JSON lines, survivors that are explained, and the page."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from audits.mutation import ROOT
from audits.mutation.change import Change
from audits.mutation.trial import Outcome

RESULTS = ROOT / "results" / "mutation" / "random.jsonl"
EXPLAINED = ROOT / "audits" / "mutation" / "explained.yaml"
PAGE = ROOT / "docs" / "mutation.md"
HEAD = """# Random mutants

Made by `python -m audits.mutation random --count {count} --seed {seed}`: {total} mutants of the {files} modules of the numerics.

- **Sampling.** Lines that can be mutated are picked at equal steps, so every file gets its share by size. On a line the
  kind of mutation is drawn first, then the mutation.
- **Mutations** change operators, comparisons, constants, indices, signs, the order of arguments and functions (min for
  max), and drop statements. Docstrings, annotations, decorators, texts and error messages are left alone.
- **Tests.** A mutant is tried on quick tests that are near by import, until one fails or {budget:g} s of tests have passed.
  A survivor here may still fail in the rest of the suite. Tests that start programs or run whole plugins take no part.
- **Killed** means that a test fails, takes five times as long or more, or that the process ends.
- **Explained** survivors change nothing that could be wrong. The reasons stand below; they are not counted in the rate.

The rate is that of a sample which the tests have seen. When each was first tried, {fallen} fell, and tests were written for
survivors after it. Some that survive here fall in the suite, by tests that the selection did not reach. *Not shown*: faults of
several lines, of a wrong idea, and those of code that was written since; lines are quoted as they were on the day of the run.

{summary}
"""


@dataclass(frozen=True)
class Explanation:
    """A survivor that no test can or should catch.

    Parameters
    ----------
    path : str
        Below the root of the checkout.
    old, new : str
        The changed lines, without indentation.
    reason : str
    """

    path: str
    old: str
    new: str
    reason: str


def results() -> dict[str, dict[str, Any]]:
    """Return the last result of every fault by its identity, with its "first" verdict; a line cut short is left out."""
    found: dict[str, dict[str, Any]] = {}
    for row in RESULTS.read_text(encoding="utf-8").splitlines() if RESULTS.exists() else []:
        try:
            result = json.loads(row)
        except json.JSONDecodeError:
            continue
        first = found.get(result["identity"], {"first": result["verdict"]})["first"]
        found[result["identity"]] = {**result, "first": first}
    return found


def add(change: Change, outcome: Outcome) -> None:
    """Append a result."""
    old, new = change.texts
    row = {"identity": change.identity, "path": change.path, "line": change.line, "kind": change.kind, "old": old}
    row |= {"new": new, "verdict": outcome.verdict, "tests": len(outcome.seconds), "cpu": round(outcome.cpu, 2)}
    row |= {"failed": outcome.failed[:1]}
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    with RESULTS.open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")


def explanations(path: Path = EXPLAINED) -> dict[tuple[str, str, str], str]:
    """Return the reasons by (path, old, new).

    Raises
    ------
    TypeError
        If an entry has other fields than path, old, new and reason.
    """
    entries = [Explanation(**entry) for entry in yaml.safe_load(path.read_text(encoding="utf-8")) or []]
    return {(entry.path, entry.old, entry.new): " ".join(entry.reason.split()) for entry in entries}


def page(changes: Sequence[Change], found: dict[str, dict[str, Any]], seed: int, budget: float) -> str:
    """Return the page as Markdown."""
    reasons = explanations()
    tried = [(change, found[change.identity]) for change in changes if change.identity in found]
    alive = [change for change, result in tried if result["verdict"] == "survived"]
    explained = [change for change in alive if (change.path, *change.texts) in reasons]
    seconds = sum(result["cpu"] for _, result in tried) / max(len(tried), 1)
    summary = (
        f"**{_rate(len(tried) - len(alive), len(tried) - len(explained))}; {len(alive) - len(explained)} survive, "
        f"{len(explained)} more are explained.** {len(changes) - len(tried)} were not run; {seconds:.1f} processor "
        "seconds a mutant."
    )
    fallen = sum(result.get("first", result["verdict"]) != "survived" for _, result in tried)
    head = HEAD.format(
        count=len(changes),
        seed=seed,
        total=len(changes),
        files=len({change.path for change in changes}),
        budget=budget,
        fallen=f"{fallen} of {len(tried)}",
        summary=summary,
    )
    tables = [
        _table("package", [change.path.split("/")[1] for change, _ in tried], tried, explained),
        _table("kind", [change.kind for change, _ in tried], tried, explained),
    ]
    living = [change for change in alive if change not in explained]
    parts = [head, *tables, "## Survivors\n", _survivors(living, {})]
    return "\n".join([*parts, "## Explained\n", _survivors(explained, reasons)])


def _rate(killed: int, counted: int) -> str:
    return f"{killed} of {counted} killed, {killed / max(counted, 1):.1%}"


def _table(
    heading: str, groups: Sequence[str], tried: Sequence[tuple[Change, dict[str, Any]]], explained: Iterable[Change]
) -> str:
    counts: dict[str, Counter[str]] = {group: Counter() for group in sorted(groups)}
    excused = set(explained)
    for group, (change, result) in zip(groups, tried, strict=True):
        counts[group]["explained" if change in excused else result["verdict"]] += 1
    rows = [f"| {heading} | mutants | killed by a test | timed out | crashed | survived | explained | kill rate |"]
    rows.append("|---|---|---|---|---|---|---|---|")
    for group, count in counts.items():
        total, counted = count.total(), count.total() - count["explained"]
        cells = [str(count[name]) for name in ("killed", "timed out", "crashed", "survived", "explained")]
        share = f"{1.0 - count['survived'] / counted:.0%}" if counted else "–"
        rows.append(f"| {group} | {total} | {' | '.join(cells)} | {share} |")
    return "\n".join(rows) + "\n"


def _survivors(changes: Iterable[Change], reasons: dict[tuple[str, str, str], str]) -> str:
    rows: list[str] = []
    previous = ""
    for change in sorted(changes, key=lambda change: (change.path, change.line)):
        if change.path != previous:
            rows.append(f"\n### {change.path}\n")
            previous = change.path
        old, new = change.texts
        reason = reasons.get((change.path, old, new))
        rows.append(f"- line {change.line}, {change.kind}: `{old}`\n  → `{new}`" + (f"\n  {reason}" if reason else ""))
    return "\n".join(rows or ["None."]) + "\n"
