"""Plots: measured orders, labels that do not meet, left-out points, and bytes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from matplotlib.colors import to_rgb

from surfexp.figures import convergence_plot as convergence_module
from surfexp.figures import cost_plot as cost_module
from surfexp.figures.axes import add_axes, class_style, label_lines, logarithmic, spread
from surfexp.figures.convergence_plot import convergence_plot
from surfexp.figures.interval_plot import interval_plot
from surfexp.figures.order_plot import order_plot
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.figures.typography import canvas, drawn
from surfexp.linalg.convergence_order import convergence_order

ITERATIONS = np.arange(1.0, 101.0)
SMALL = (400, 260)


@given(st.floats(0.5, 6.0), st.floats(1e-3, 1e3), st.integers(2, 7))
def test_order_of_a_power_is_its_exponent(order: float, factor: float, count: int) -> None:
    h = 0.5 ** np.arange(count)
    assert convergence_order(h, factor * h**order) == pytest.approx(order, rel=1e-9)


def test_order_is_that_of_the_finer_half_in_any_sequence() -> None:
    h = 0.5 ** np.arange(6.0)
    errors = np.where(h > 0.2, 1.0, h**3)
    shuffled = np.random.default_rng(0).permutation(6)
    assert convergence_order(h[shuffled], errors[shuffled]) == pytest.approx(3.0)
    figure = order_plot(h, {"P2": errors}, size=SMALL)
    assert figure.metrics == {"order P2": pytest.approx(3.0)}


@given(arrays(float, st.integers(1, 12), elements=st.floats(0.0, 100.0)), st.floats(0.1, 20.0))
def test_labels_are_spread_as_little_as_possible(positions: np.ndarray, spacing: float) -> None:
    result = spread(positions, spacing)
    ordered = np.sort(result)
    assert (np.diff(ordered) >= spacing * (1.0 - 1e-9) - 1e-9).all()
    assert result.mean() == pytest.approx(positions.mean(), abs=1e-8)
    order = np.argsort(positions, kind="stable")
    assert (np.diff(result[order]) >= 0.0).all()
    if (np.diff(np.sort(positions)) >= spacing).all():
        assert np.allclose(result, positions)


@given(arrays(float, st.integers(1, 12), elements=st.floats(0.0, 100.0)), st.floats(0.1, 20.0))
def test_bounded_spread_stays_inside_and_gives_way_only_without_room(positions: np.ndarray, spacing: float) -> None:
    result = spread(positions, spacing, -5.0, 105.0)
    assert result.min() >= -5.0 - 1e-9 and result.max() <= 105.0 + 1e-9
    room = 110.0 / max(len(positions) - 1, 1)
    assert (np.diff(np.sort(result)) >= min(spacing, room) * (1.0 - 1e-9) - 1e-9).all()
    free = spread(positions, spacing)
    if free.min() >= -5.0 and free.max() <= 105.0:
        assert np.allclose(result, free)


@pytest.mark.parametrize("level", [0.0, 1.0])
def test_labels_of_lines_that_end_at_one_corner_are_inside_the_figure(level: float) -> None:
    with canvas(600, 300) as figure:
        axes = add_axes(figure, "title", "x", "y")
        axes.plot([0.0, 1.0], [0.0, 1.0])
        label_lines(axes, [(f"line {k}", 1.0, level, "black") for k in range(9)])
        boxes = [text.get_window_extent() for text in figure.texts]
    assert all(box.y0 >= 0.0 and box.y1 <= 300.0 for box in boxes)


def test_lines_that_lie_on_one_another_are_all_seen_and_long_ones_have_no_markers() -> None:
    line = np.sqrt(ITERATIONS)
    figure = sweep_plot(ITERATIONS, {"a": line, "b": line, "c": line}, x_label="x", y_label="y", size=SMALL)
    colours = {tuple(c) for c in figure.pixels[60:-60, 60:-100].reshape(-1, 3).tolist()}
    assert {(0, 114, 178), (213, 94, 0), (0, 158, 115)} <= colours


def test_49_classes_differ_in_colour_or_marker() -> None:
    assert len({class_style(k) for k in range(49)}) == 49


def test_labels_are_inside_the_figure_and_apart() -> None:
    with canvas(600, 400) as figure:
        axes = add_axes(figure, "", "x", "y")
        axes.plot([0.0, 1.0], [0.0, 1.0])
        names = ["one", "a much longer name", "three"]
        label_lines(axes, [(name, 1.0, 0.5 + 0.001 * k, "black") for k, name in enumerate(names)])
        boxes = [text.get_window_extent() for text in figure.texts]
        right = axes.bbox.x1
    assert all(box.x1 <= 600 and box.x0 >= right for box in boxes)
    assert all(low.y1 <= high.y0 for low, high in pairwise(boxes))


def test_logarithmic_axes_have_ticks_within_two_decades() -> None:
    with canvas(*SMALL) as figure:
        axes = add_axes(figure, "", "x", "y")
        axes.plot([0.11, 0.9], [1e-9, 1.0])
        logarithmic(axes)
        figure.canvas.draw()
        seen = [text.get_text() for text in axes.get_xticklabels() if text.get_text()]
    assert {"0.2", "0.5"} <= set(seen)


def test_points_that_are_not_positive_are_left_out_and_counted() -> None:
    gaps = ITERATIONS**-1.0
    gaps[[3, 50]] = 0.0, np.nan
    figure = convergence_plot({"a": (ITERATIONS, gaps), "b": (ITERATIONS, -gaps)}, rates=(1, 2), size=SMALL)
    assert figure.notes == ("102 points that are not positive are left out.",)
    assert convergence_plot({"a": (ITERATIONS, ITERATIONS**-1.0)}, size=SMALL).notes == ()


def test_every_plot_is_drawn_the_same_again() -> None:
    band = np.stack([ITERATIONS, 0.9 * ITERATIONS, 1.1 * ITERATIONS], axis=1)
    for plot in (
        lambda: convergence_plot({"one": (np.array([7.0]), np.array([0.1]))}, rates=(1,), size=SMALL),
        lambda: order_plot(np.array([1.0, 0.5]), {"P1": np.array([1.0, 0.2])}, size=SMALL),
        lambda: sweep_plot(ITERATIONS, {"a": band, "b": ITERATIONS}, x_label="x", y_label="y", log="xy", size=SMALL),
        lambda: interval_plot({"a": (1, 0, 2), "b": (2, 2, 2)}, x_label="x", reference=0.0, title="t", width=400),
    ):
        first, second = plot().pixels, plot().pixels
        assert first.std() > 5.0 and first.shape[1] == 400 and (first == second).all()


def test_sweep_keeps_gaps_and_refuses_other_lengths() -> None:
    y = np.where(ITERATIONS == 100.0, np.nan, ITERATIONS)
    assert sweep_plot(ITERATIONS, {"a": y}, x_label="x", y_label="y", size=SMALL).pixels.std() > 5.0
    with pytest.raises(ValueError, match=r"'a' has shape \(7,\), expected \(100,\) or \(100, 3\)"):
        sweep_plot(ITERATIONS, {"a": np.zeros(7)}, x_label="x", y_label="y")


@pytest.mark.parametrize(
    "empty",
    [
        lambda: convergence_plot({}),
        lambda: convergence_plot({"a": (ITERATIONS, 0.0 * ITERATIONS)}),
        lambda: order_plot(ITERATIONS, {}),
        lambda: sweep_plot(ITERATIONS, {"a": np.nan * ITERATIONS}, x_label="", y_label=""),
        lambda: interval_plot({}, x_label=""),
    ],
)
def test_plots_of_nothing_are_refused(empty) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(ValueError, match="at least 1"):
        empty()
    with pytest.raises(ValueError, match="positive numbers"):
        convergence_order(np.array([1.0, 0.5]), np.array([1.0, 0.0]))


def test_powers_are_straight_lines_in_a_convergence_plot(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    monkeypatch.setattr(convergence_module, "drawn", lambda figure: seen.append(figure.axes[0]) or drawn(figure))
    convergence_plot({"a": (ITERATIONS, ITERATIONS**-2.0)}, rates=(2,), size=SMALL)
    (axes,) = seen
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")


def test_the_range_of_seconds_is_a_band_of_the_colour_of_its_line(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    monkeypatch.setattr(cost_module, "drawn", lambda figure: seen.append(figure.axes[0]) or drawn(figure))
    seconds = np.array([[1.0, 0.5, 2.0], [3.0, 2.0, 5.0]])
    with pytest.raises(ValueError, match="cost plot has 0 methods"):
        cost_module.cost_plot({}, title="", caption="", size=SMALL)
    cost_module.cost_plot({"a": (np.array([1e-2, 1e-4]), seconds)}, title="", caption="", size=SMALL)
    (axes,) = seen
    (band,), (line, *_) = axes.collections, axes.lines
    corners = band.get_paths()[0].vertices
    assert corners[:, 0].min() == 0.5 and corners[:, 0].max() == 5.0
    assert to_rgb(line.get_color()) == pytest.approx(band.get_facecolor()[0][:3])
