"""The verdicts on an experiment's claims, in the terminal below its tables."""

from __future__ import annotations

from collections.abc import Sequence

from rich.markup import escape

from surfexp.commands.console import Console
from surfexp.commands.views import lines_for
from surfexp.lab.experiment.claim import read_claims
from surfexp.lab.plan.plan import Plan
from surfexp.records.table import Row
from surfexp.report.verdict import Verdict, judge

STYLES = {
    "reproduced": "green",
    "holds": "green",
    "not comparable": "cyan",
    "corrected": "yellow",
    "not reproduced": "red",
    "does not hold": "red",
    "not computed": "yellow",
}


def print_verdicts(plan: Plan, rows: Sequence[Row], console: Console) -> None:
    """Print each claim with its verdict, the number found and the interval asked, worst last."""
    order = list(STYLES)
    found = sorted(verdicts_of(plan, rows), key=lambda item: order.index(item.verdict))
    for item in found:
        style = STYLES[item.verdict]
        first, *rest = lines_for(f"{item.verdict}  {statement(item)}", console)
        said = escape(first.removeprefix(item.verdict))
        console.print(f"[{style}]{item.verdict}[/{style}]{said}", soft_wrap=True)
        for line in rest:
            console.print(escape(line), soft_wrap=True)
    if found:
        console.print()


def verdicts_of(plan: Plan, rows: Sequence[Row]) -> list[Verdict]:
    """The verdicts on the claims of an experiment, in their order."""
    return judge(read_claims(plan.settings.claims), rows)


def statement(item: Verdict) -> str:
    """A claim, what was found and what was asked."""
    asked = f"{item.quantity} {item.number}, {_compared_with(item)}"
    return f"{item.claim.claim}: {item.obstacle or asked}"


def _compared_with(item: Verdict) -> str:
    """The interval, or the published value beside which the number stands without a verdict."""
    if item.claim.interval is None:
        return f"published {item.claim.value} ({item.why})"
    return f"asked {item.interval}"
