"""A search for the least value of a metric: its trials as one experiment, the best of them, and a picture of all."""

from __future__ import annotations

import math
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from surfexp.lab.store import store
from surfexp.records.table import Row
from surfexp.records.written_numbers import format_number

PICTURE = "search.svg"
WIDTH, HEIGHT = 1000, 430
OPTIONS_DRAWN = 3


@dataclass(frozen=True)
class Trial:
    """What one trial set, and the objective over its rows: not a number where a row failed or lacks the metric."""

    options: Mapping[str, Any]
    value: float


@dataclass(frozen=True)
class Search:
    """The trials of a search in their order.

    Parameters
    ----------
    objective : str
        The metric whose mean over a trial's rows is least at the best trial.
    trials : sequence of Trial
        At least one.
    arguments : sequence of str
        As of `surfexp run`.
    """

    objective: str
    trials: Sequence[Trial]
    arguments: Sequence[str]

    @property
    def best(self) -> Trial | None:
        """The trial with the least value; None where no trial has one."""
        known = [trial for trial in self.trials if math.isfinite(trial.value)]
        return min(known, key=lambda trial: trial.value) if known else None

    @property
    def sentence(self) -> str:
        """The outcome, as a page and a terminal say it."""
        metric, count = self.objective.replace("_", " "), len(self.trials)
        trials = f"{count} trial{'s' * (count != 1)} of {', '.join(self.trials[0].options)}"
        if self.best is None:
            return f"{trials}; none has a value of {metric}"
        at = ", ".join(f"{name} = {_shown(value)}" for name, value in self.best.options.items())
        return f"{trials}; the least {metric}, {format_number(self.best.value)}, at {at}"

    @property
    def command(self) -> str:
        """What runs the best trial alone."""
        found = self.best.options if self.best else {}
        kept = [text for text in self.arguments if not _of_search(text) and _name(text) not in found]
        chosen = [f"{name.removesuffix('.name')}={value}" for name, value in found.items()]
        return shlex.join(["surfexp", "run", *kept, *chosen])


def search_of(rows: Sequence[Row], objective: str | None, command: str) -> Search | None:
    """Return the search that a command asked for; None where it asked for none.

    Parameters
    ----------
    rows : sequence of Row
        Of all trials, in their order.
    objective : str or None
        The metric.
    command : str
        As `surfexp.records.origin` notes it.
    """
    arguments = shlex.split(command)[2:]
    if not objective or not rows or not any(text.startswith("hydra/sweeper=") for text in arguments):
        return None
    names = searched(arguments)
    values: dict[tuple[Any, ...], list[float]] = {}
    for row in rows:
        key = tuple(row.parameters.get(name) for name in names)
        values.setdefault(key, []).append(math.nan if row.failure else row.metrics.get(objective, math.nan))
    trials = [Trial(dict(zip(names, key, strict=True)), sum(some) / len(some)) for key, some in values.items()]
    return Search(objective, trials, arguments) if names else None


def searched(arguments: Sequence[str]) -> list[str]:
    """Names of the parameters that a sweep of the command line goes over."""
    from hydra.core.override_parser.overrides_parser import OverridesParser

    words = [text for text in arguments if "=" in text and not text.startswith("-")]
    parsed = zip(words, OverridesParser.create().parse_overrides(words), strict=True)
    return [_name(text) for text, override in parsed if override.is_sweep_override()]


def _name(text: str) -> str:
    key = text.partition("=")[0].lstrip("+")
    return key if "." in key else f"{key}.name"


def _of_search(text: str) -> bool:
    return text.lstrip("+").startswith(("hydra/", "hydra.", "objective="))


def _shown(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def write_search(search: Search, folder: Path) -> str:
    """Draw a search into a folder; return the name of the file."""
    store.write_text(folder / PICTURE, draw(search))
    return PICTURE


def draw(search: Search) -> str:
    """Return a search as SVG text: its history with the best so far, and the objective against each option."""
    from surfexp.figures.typography import canvas, vector

    names = list(search.trials[0].options)[:OPTIONS_DRAWN]
    with canvas(WIDTH, HEIGHT) as figure:
        width = (0.92 - 0.05 * len(names)) / (len(names) + 1)
        for place, name in enumerate(["", *names]):
            axes = figure.add_axes((0.07 + place * (width + 0.05), 0.17, width, 0.7))
            _draw_panel(axes, search, name, place == 0)
        return vector(figure, outlines=False)


def _draw_panel(axes: Any, search: Search, name: str, first: bool) -> None:
    """One panel: the objective against the number of the trial, or against an option; the best trial is a ring."""
    from surfexp.figures.axes import COLORS, FONT
    from surfexp.figures.typography import QUIET, points

    em = FONT * WIDTH
    found: list[Any] = [trial.options[name] if name else k for k, trial in enumerate(search.trials, 1)]
    if numbers := all(isinstance(value, int | float) and not isinstance(value, bool) for value in found):
        places = [float(value) for value in found]
    else:
        words = list(dict.fromkeys(map(str, found)))
        places = [float(words.index(str(value))) for value in found]
        axes.set_xticks(range(len(words)), words)
        axes.set_xlim(-0.5, len(words) - 0.5)
    values = [trial.value for trial in search.trials]
    axes.plot(places, values, linestyle="none", marker="o", markersize=5, color=COLORS[0])
    if search.best is not None:
        best = search.trials.index(search.best)
        axes.plot(places[best], values[best], marker="o", markersize=12, color="none", markeredgecolor=COLORS[1], mew=2)
    if not name:
        least, steps = math.inf, []
        for value in values:
            least = min(least, value) if math.isfinite(value) else least
            steps.append(least)
        axes.step(places, steps, where="post", color=QUIET, linewidth=1.2, zorder=0)
    axes.set_xlabel(name.replace("_", " ") if name else "trial", fontsize=points(0.9 * em))
    if first:
        axes.set_ylabel(search.objective.replace("_", " "), fontsize=points(0.9 * em))
        axes.set_title("best so far: line", fontsize=points(0.9 * em), color=QUIET)
    axes.tick_params(labelsize=points(0.8 * em), labelleft=first)
    if numbers:
        axes.locator_params(axis="x", nbins=4, integer=not name)
    axes.grid(visible=True, color="#e6e6e6", linewidth=0.8)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
