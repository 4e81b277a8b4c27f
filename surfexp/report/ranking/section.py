"""What a report page shows of the rankings of a table, and their pictures as files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from surfexp.lab.store import store
from surfexp.records.comparison import Comparison
from surfexp.records.written_numbers import format_number
from surfexp.report.ranking.trials import trials_of
from surfexp.report.repeats import mean_and_deviation

if TYPE_CHECKING:
    from surfexp.report.ranking.ranking import Ranking

RANKINGS_SHOWN = 3


@dataclass(frozen=True)
class RankingLine:
    """One method in the table of a ranking; texts as shown."""

    method: str
    rank: str
    mean: str
    difference: str
    p: str
    solved: int


@dataclass(frozen=True)
class RankingShown:
    """A ranking as the page shows it; `file` is its picture below `figures/`."""

    metric: str
    unit: str
    file: str
    problems: int
    data: int
    lines: list[RankingLine]
    friedman: str
    left_out: tuple[str, ...]


def write_rankings(group: Comparison, folder: Path, number: int) -> list[RankingShown]:
    """Draw the rankings of a table, of its first metrics, into a folder."""
    found = trials_of(group)[:RANKINGS_SHOWN]
    if not found:
        return []
    # the tests and the plots are imported where a table has something to rank
    from surfexp.report.ranking.drawing import draw
    from surfexp.report.ranking.ranking import rank

    shown = []
    for place, trials in enumerate(found):
        ranking, name = rank(trials), f"ranking-{number}-{place}.svg"
        store.write_text(folder / name, draw(ranking))
        friedman = "" if ranking.p_friedman != ranking.p_friedman else format_number(ranking.p_friedman)
        metric = trials.metric.replace("_", " ")
        count, data = len(trials.values), len(set(trials.samples.tolist()))
        shown.append(RankingShown(metric, trials.unit, name, count, data, _lines(ranking), friedman, trials.left_out))
    return shown


def _lines(ranking: Ranking) -> list[RankingLine]:
    count, lines = len(ranking.trials.values), []
    for k, (method, failed) in enumerate(zip(ranking.methods, ranking.failed, strict=True)):
        mean = mean_and_deviation(float(ranking.mean[k]), float(ranking.deviation[k]))
        low, high = (format_number(float(end[k])) for end in (ranking.low, ranking.high))
        known = ranking.difference[k] == ranking.difference[k]
        difference = f"{format_number(float(ranking.difference[k]))} ({low} to {high})" if known else "–"
        p = format_number(float(ranking.p[0, k])) if k else "–"
        lines.append(RankingLine(method, f"{ranking.ranks[k]:.2f}", mean, difference, p, count - failed))
    return lines
