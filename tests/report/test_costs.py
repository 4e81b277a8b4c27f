"""The cost figure is drawn where clocks and gaps of several methods exist, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surfexp.figures.cost_plot import cost_plot
from surfexp.lab.plan.plan import Leaf
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.report.costs import cost_figure


def row(name: str, tolerance: float, seconds: float, gap: float | None = None, failure: str = "") -> Row:
    parameters = {"solver.name": name, "solver.tolerance": tolerance}
    metrics = {"relative_gap": tolerance if gap is None else gap}
    return Row(Leaf(name, name, {}), parameters, metrics, seconds, failure=failure)


def comparison(*rows: Row) -> Comparison:
    return Comparison("", "", list(rows), [])


TWO_METHODS = [row(name, 10.0**-k, k * speed) for name, speed in (("a", 1.0), ("b", 3.0)) for k in (1, 2, 3)]


def test_two_methods_at_several_tolerances_are_drawn() -> None:
    figure = cost_figure(comparison(*TWO_METHODS))
    assert figure is not None and figure.pixels.std() > 0


@pytest.mark.parametrize(
    "rows",
    [
        TWO_METHODS[:3],
        [TWO_METHODS[0], TWO_METHODS[3]],
        [row(r.parameters["solver.name"], 0.1, 1.0, gap=0.0) for r in TWO_METHODS],
        [row(r.parameters["solver.name"], 10.0**-k, 1.0, failure="x") for k, r in enumerate(TWO_METHODS)],
    ],
    ids=["one method", "one tolerance", "no gap", "failed"],
)
def test_nothing_is_drawn_of_less(rows: list[Row]) -> None:
    assert cost_figure(comparison(*rows)) is None


def test_the_faster_method_is_drawn_to_the_left() -> None:
    seconds = np.array([[1.0, 1.0, 1.0], [2.0, 2.0, 2.0]])
    gaps = np.array([1e-1, 1e-2])
    one = cost_plot({"a": (gaps, seconds), "b": (gaps, 100.0 * seconds)}).pixels.astype(float)
    # the first colour is blue, the second vermilion: where they are in the picture
    blue, red = (np.flatnonzero((one[..., high] - one[..., low] > 80).any(axis=0)) for high, low in ((2, 0), (0, 2)))
    assert blue.min() < red.min()


@pytest.mark.parametrize("methods", [{}, {"a": (np.array([0.1]), np.zeros((1, 3)))}])
def test_what_cannot_be_drawn_is_refused(methods: dict[str, tuple[np.ndarray, np.ndarray]]) -> None:
    with pytest.raises(ValueError, match=r"at least 1|positive"):
        cost_plot(methods)


def test_a_caption_names_what_a_band_goes_over() -> None:
    plain = cost_figure(comparison(*TWO_METHODS))
    rows = [
        *TWO_METHODS,
        *(row(r.parameters["solver.name"], r.parameters["solver.tolerance"], 9.0) for r in TWO_METHODS),
    ]
    rows = [
        replace(one, parameters={**one.parameters, "surface.levels": number // len(TWO_METHODS)})
        for number, one in enumerate(rows)
    ]
    banded = cost_figure(comparison(*rows))
    assert plain is not None and banded is not None
    assert "band" not in plain.caption and "seed" not in plain.caption
    assert "over surface levels" in banded.caption and "seed" not in banded.caption
