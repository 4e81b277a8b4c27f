"""The picture of a ranking: a critical-difference diagram, and beside it the performance profile where there is one."""

from __future__ import annotations

from typing import Any

import numpy as np

from surfexp.figures.axes import COLORS, FONT, Label, label_lines, logarithmic, style
from surfexp.figures.typography import INK, QUIET, canvas, points, vector
from surfexp.report.ranking.profile import has_profile, profiles
from surfexp.report.ranking.ranking import Ranking

WIDTH, LINE, PLOT_HEIGHT = 1000, 30, 470
# where no method is farther from the best, the steps of a profile are one line
LEAST_FACTOR = 1.2


def draw(ranking: Ranking) -> str:
    """Return a ranking as SVG text: mean ranks on a line, bars over methods that do not differ, and below the profile.

    Text stays text, so that it can be searched and read aloud; the same ranking gives the same bytes.
    """
    rows = len(ranking.methods) + len(ranking.groups)
    top = LINE * (rows + 4)
    profile = has_profile(ranking.trials) and profiles(ranking.trials)[0][-1] >= LEAST_FACTOR
    height = top + (PLOT_HEIGHT if profile else 0)
    with canvas(WIDTH, height) as figure:
        _draw_ranks(figure, ranking, 1.0 - top / height, top / height)
        if profile:
            _draw_profile(figure, ranking, PLOT_HEIGHT / height)
        return vector(figure, outlines=False)


def _draw_ranks(figure: Any, ranking: Ranking, bottom: float, height: float) -> None:
    """One line a method, from the left: its mean rank as a point with its name; bars join what tests do not tell apart."""
    m, em = len(ranking.methods), FONT * WIDTH
    axes = figure.add_axes((0.04, bottom + 0.01, 0.92, height - 3.2 * LINE / figure.bbox.height))
    axes.set_xlim(0.8, m + 0.2 + 0.75 * (m - 0.6))
    axes.set_ylim(m + len(ranking.groups) + 0.2, 0.2)
    axes.xaxis.tick_top()
    axes.set_xticks(range(1, m + 1))
    axes.tick_params(labelsize=points(0.9 * em), length=0.0)
    axes.yaxis.set_visible(False)
    for spine in axes.spines.values():
        spine.set_visible(False)
    metric, count = ranking.trials.metric.replace("_", " "), len(ranking.trials.values)
    title = f"Mean rank by {metric} on {count} problems, 1 is best"
    axes.set_title(title, fontsize=points(1.1 * em), fontweight="bold", pad=points(0.9 * em))
    for place, (name, mean) in enumerate(zip(ranking.methods, ranking.ranks, strict=True), 1):
        axes.plot([1.0, m], [place, place], color="#e6e6e6", linewidth=0.8, zorder=1)
        axes.plot([mean], [place], marker="o", markersize=9, color=COLORS[(place - 1) % len(COLORS)], zorder=3)
        text = f"{name}  {mean:.2f}"
        axes.text(m + 0.15, place, text, va="center", fontsize=points(em), color=INK)
    for line, (first, last) in enumerate(ranking.groups, 1):
        height_of_bar = m + line
        ends = ranking.ranks[first] - 0.04, ranking.ranks[last] + 0.04
        axes.plot(ends, [height_of_bar] * 2, color=QUIET, linewidth=6.0, solid_capstyle="butt")
        axes.text(m + 0.15, height_of_bar, "not told apart", va="center", fontsize=points(0.9 * em), color=QUIET)


def _draw_profile(figure: Any, ranking: Ranking, height: float) -> None:
    """Steps: from the left the share of problems on which a method is best, on the right the share that it solves."""
    em = FONT * WIDTH
    axes = figure.add_axes((0.08, 0.16 * height, 0.9, 0.68 * height))
    factors, shares = profiles(ranking.trials)
    end = max(2.0, 1.1 * factors[-1])
    labels: list[Label] = []
    for k, (place, name) in enumerate(zip(ranking.order, ranking.methods, strict=True)):
        drawn = style(k) | {"marker": ""}
        axes.step(np.append(factors, end), np.append(shares[:, place], shares[-1, place]), where="post", **drawn)
        labels.append((name, end, float(shares[-1, place]), drawn["color"]))
    axes.set_ylim(-0.03, 1.03)
    axes.set_xlim(1.0, end)
    logarithmic(axes, "x")
    axes.set_xlabel(f"{ranking.trials.metric.replace('_', ' ')}, times the best", fontsize=points(em))
    axes.set_ylabel("share of problems", fontsize=points(em))
    axes.set_title("Solved within a factor of the best", fontsize=points(1.1 * em), fontweight="bold")
    axes.tick_params(labelsize=points(0.9 * em), which="major")
    label_lines(axes, labels)
