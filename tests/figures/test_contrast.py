"""Words in figures can be read: their contrast, the numbers of axes, and what bands are."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import rgb_to_hsv, to_rgb

from surfexp.figures.axes import COLORS, add_axes, label_lines, logarithmic
from surfexp.figures.contrast import LEAST, contrast, ink_like, ink_on
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.figures.typography import INK, QUIET, canvas


def test_contrast_is_that_of_the_standard() -> None:
    assert contrast("black", "white") == pytest.approx(21.0)
    # the grey of WCAG's own examples
    assert contrast("#767676", "white") == pytest.approx(4.54, abs=0.005)
    assert contrast("#777777", "white") < LEAST <= contrast(QUIET, "white") < contrast(INK, "white")


@pytest.mark.parametrize("color", COLORS)
def test_a_line_is_named_in_its_hue_dark_enough_to_be_read(color: str) -> None:
    word = ink_like(color)
    assert contrast(word, "white") >= LEAST
    if max(to_rgb(color)) > 0.0:
        assert rgb_to_hsv(word)[0] == pytest.approx(rgb_to_hsv(to_rgb(color))[0], abs=1e-9)
    with canvas(600, 300) as figure:
        axes = add_axes(figure, "title", "x", "y")
        axes.plot([0.0, 1.0], [0.0, 1.0], color=color)
        label_lines(axes, [("line", 1.0, 1.0, color)])
        assert contrast(figure.texts[0].get_color(), "white") >= LEAST
        assert to_rgb(axes.lines[0].get_color()) == to_rgb(color)


@pytest.mark.parametrize("level", np.linspace(0.0, 1.0, 21))
def test_words_on_any_grey_can_be_read(level: float) -> None:
    assert contrast(ink_on((level,) * 3), (level,) * 3) >= LEAST


@pytest.mark.parametrize(
    ("ends", "shown"),
    [
        ((0.5, 200.0), {1.0: "1", 100.0: "100"}),
        ((1e4, 6.4e5), {1e4: "10\u202f000", 5e5: "500\u202f000"}),
        ((1e-3, 2.0), {0.01: "0.01", 1.0: "1"}),
    ],
)
def test_numbers_of_an_axis_are_written_out(ends: tuple[float, float], shown: dict[float, str]) -> None:
    with canvas(600, 300) as figure:
        axes = add_axes(figure, "", "x", "y")
        axes.plot(ends, ends)
        logarithmic(axes, "x")
        words = {value: axes.xaxis.get_major_formatter()(value, 0) for value in shown}
    assert words == shown


def test_a_far_range_keeps_its_powers_of_ten() -> None:
    with canvas(600, 300) as figure:
        axes = add_axes(figure, "", "x", "y")
        axes.plot([1e-10, 1.0], [1.0, 2.0])
        logarithmic(axes, "x")
        assert "10^{-8}" in axes.xaxis.get_major_formatter()(1e-8, 0)


def test_a_figure_says_what_its_bands_are() -> None:
    x, bounded = np.arange(3.0), np.stack([np.arange(3.0), np.zeros(3), np.ones(3)], axis=1)
    words = {"x_label": "x", "y_label": "y", "size": (400, 260)}
    plain = sweep_plot(x, {"a": bounded}, **words)
    told = sweep_plot(x, {"a": bounded}, band="95 % interval", **words)
    assert (plain.pixels != told.pixels).any()
    # nothing is cut off
    assert (told.pixels[-2:] == 255).all()
    assert (
        sweep_plot(x, {"a": x}, band="95 % interval", **words).pixels == sweep_plot(x, {"a": x}, **words).pixels
    ).all()
