"""The page of verdicts over all experiments: counts at its head, a section for each experiment with the state of its stages.

A section stays true as long as the keys of its stages do: those of other experiments are taken over from an earlier page.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

from surfexp.lab.experiment.claim import PLACES, read_claims
from surfexp.lab.plan.plan import Plan
from surfexp.records.table import rows_of
from surfexp.report.verdict import Verdict, judge
from surfexp.reproduction.pages import HEADING
from surfexp.reproduction.stamp import STATE, commit_of_page, cost, state_line, state_of_plan

HEADER = ("claim", "source", "quantity", "interval", "because", "rows", "found (least to largest)", "verdict", "cause")
FOUND = HEADER.index("found (least to largest)")
PLACE = re.compile(rf"((?:{'|'.join(PLACES)}) [^:]+): (.*)")
NAME = re.compile(r"`surfexp run experiment=([\w.-]+)`")
RUNS = re.compile(r"^(?:Run|Then): .*$", re.MULTILINE)


def reproduction(plans: Mapping[str, Plan], results: Path, earlier: str = "", preface: str = "") -> str:
    """Markdown of the verdicts of several experiments; those without claims are left out.

    Parameters
    ----------
    plans : mapping of name to Plan
        Experiments that were computed in `results`.
    results : Path
    earlier : str, optional
        A page from which the sections of all other experiments are taken over as they are.
    preface : str, optional
        What stands at the head of the page.
    """
    sections = sections_of(earlier)
    taken_over = sections.keys() - plans.keys()
    for name, plan in plans.items():
        sections.pop(name, None)
        if plan.settings.claims:
            verdicts = judge(read_claims(plan.settings.claims), rows_of(plan, results))
            chapter = plan.settings.chapter[0] if plan.settings.chapter else 0
            sections[name] = section(name, plan.settings.title, verdicts, state_of_plan(plan), chapter)
    ran = cost(plans, results)
    runs = [*RUNS.findall(earlier), f"Then: {', '.join(sorted(plans))}. {ran}"] if taken_over else [f"Run: {ran}"]
    text = "".join(sections[name] for name in sorted(sections))
    head = ["# The dissertation, checked", *([preface.strip()] if preface else [])]
    # of a page some sections of which are older, `renew` tells whether all are of the present state
    before = STATE.search(earlier) if taken_over else None
    head += [counts_of(sections), before[0] if before else state_line(), *runs]
    return ("\n\n".join(head) + "\n" + text).rstrip()


def counts_of(sections: Mapping[str, str]) -> str:
    """How many verdicts of each word there are, on the dissertation, on others, and on what is ours."""
    counts: dict[str, Counter[str]] = {"The dissertation": Counter(), "Others": Counter(), "Ours": Counter()}
    for text in sections.values():
        for row in rows_of_section(text):
            source = row[HEADER.index("source")]
            group = "Ours" if source == "ours" else "The dissertation" if PLACE.match(source) else "Others"
            counts[group][row[FOUND + 1].strip("*")] += 1
    return "\n".join(
        f"- {group}: {found.total()} claims, {', '.join(f'{number} {word}' for word, number in sorted(found.items()))}"
        for group, found in counts.items()
        if found
    )


def sections_of(page: str) -> dict[str, str]:
    """The sections of a page by the names of their experiments."""
    parts = [HEADING + part for part in page.split(HEADING)[1:]]
    return {found[1]: part.rstrip("\n") + "\n" for part in parts if (found := NAME.search(part))}


def verdicts_of_section(section: str) -> dict[str, list[str]]:
    """Verdict, number and reason of each claim of a section, as `section` wrote them."""
    return {row[0]: [row[FOUND + 1].strip("*"), row[FOUND], row[-1]] for row in rows_of_section(section)}


def rows_of_section(section: str) -> list[list[str]]:
    """The cells of the rows of a section's table, without its header."""
    return [cells_of_line(line) for line in section.splitlines() if line.startswith("| ")][1:]


def cells_of_line(line: str) -> list[str]:
    """The cells of a line of a table, of which none is empty."""
    return [cell.replace("\\|", "|") for cell in re.split(r"(?<!\\) \| ", line[2:-2])]


def section(experiment: str, title: str, verdicts: Sequence[Verdict], state: str, chapter: int = 0) -> str:
    """The verdicts of one experiment, below a heading that is its name."""
    made = (
        f"`surfexp run experiment={experiment}`; state {state}, {datetime.now(UTC):%Y-%m-%d}, commit {commit_of_page()}"
    )
    made += f", chapter {chapter}" if chapter else ""
    lines = [f"{HEADING}{experiment}", "", *([f"**{title}**", ""] if title else []), made, ""]
    lines += [line_of_cells(HEADER), "|" + "---|" * len(HEADER)]
    for item in verdicts:
        moved = f" (before the result: {item.claim.moved})" if item.claim.moved else ""
        reason = "–" if item.claim.interval is None else item.claim.reason
        cells = (item.claim.claim, item.claim.source, item.quantity, item.interval + moved, reason)
        lines.append(line_of_cells((*cells, str(item.count), item.number, f"**{item.verdict}**", item.why or "–")))
    return "\n".join([*lines, ""])


def line_of_cells(cells: Sequence[str]) -> str:
    """A line of a table; `cells_of_line` reads it."""
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
