"""The page of verdicts over all experiments: counts at its head, a table for each experiment."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from surfexp.report.claim import read_claims
from surfexp.report.stamp import stamp
from surfexp.report.table import rows_of
from surfexp.report.verdict import Verdict, judge
from surfexp.workflow.plan import Plan

HEADER = ("claim", "source", "quantity", "interval", "because", "rows", "found (least to largest)", "verdict", "cause")


def reproduction(plans: Mapping[str, Plan], results: Path) -> str:
    """Markdown of the verdicts of several experiments; those without claims are left out."""
    verdicts = {name: judge(read_claims(plan.settings.claims), rows_of(plan, results)) for name, plan in plans.items()}
    every = [verdict for group in verdicts.values() for verdict in group]
    counts = Counter(verdict.verdict for verdict in every)
    told = ", ".join(f"{number} {word}" for word, number in sorted(counts.items()))
    sections = [section(name, plans[name].settings.title, group) for name, group in verdicts.items() if group]
    head = f"# Published claims, checked\n\n{len(every)} claims: {told}.\n\n{stamp(plans.values(), results)}\n"
    return "\n".join([head, *sections]).rstrip()


def section(experiment: str, title: str, verdicts: Sequence[Verdict]) -> str:
    """The verdicts of one experiment."""
    lines = [f"## {title or experiment}", "", f"`surfexp run experiment={experiment}`", ""]
    lines += [_line(HEADER), "|" + "---|" * len(HEADER)]
    for item in verdicts:
        moved = f" (before the result: {item.claim.moved})" if item.claim.moved else ""
        cells = (item.claim.claim, item.claim.source, item.quantity, item.interval + moved, item.claim.because)
        lines.append(_line((*cells, str(item.count), item.number, f"**{item.verdict}**", item.why or "–")))
    return "\n".join([*lines, ""])


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
