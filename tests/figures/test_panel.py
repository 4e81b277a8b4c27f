"""Panels: equal scale, shared limits, bars with the right ticks, and notes."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise

import matplotlib
import numpy as np
import pytest

from surfexp.figures.camera import fit_camera
from surfexp.figures.color_bar import bars_height, draw_bars, fitted_scales
from surfexp.figures.colormap import ColorScale
from surfexp.figures.labelling import labelling
from surfexp.figures.panel import surface_panel
from surfexp.figures.panel_layout import BAR_BAND, arrange, text_size
from surfexp.figures.render import SurfaceView, draw
from surfexp.figures.typography import canvas, drawn
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

SPHERE = icosphere(2).mesh
HALF = TriangleMesh(0.5 * SPHERE.vertices, SPHERE.faces)
Z = SPHERE.vertices[:, 2]
GREY = ColorScale("grey value", "", "gray", (0.0, 255.0))
DIFFERENCE = ColorScale("residual", "mm", "RdBu_r")


def test_pictures_of_one_panel_have_one_scale() -> None:
    pixels = surface_panel([SurfaceView(SPHERE), SurfaceView(HALF)], width=600).pixels
    inked = (pixels < 250).any(axis=(0, 2))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], inked.astype(int), [0]])))
    widths = np.diff(edges)[::2]
    assert len(widths) == 2 and widths[0] == pytest.approx(2 * widths[1], abs=2)


def test_panel_holds_the_very_pixels_of_the_pictures() -> None:
    view = SurfaceView(SPHERE, 100.0 + 50.0 * Z, "top", GREY)
    layout = arrange([[view, view]], 500, False, round(BAR_BAND * text_size(500)), 0.0)
    pixels = surface_panel([view, view], width=500).pixels
    assert pixels.shape == (layout.height, 500, 3)
    size = (layout.columns[1], layout.rows[0])
    alone = draw(view, fit_camera(SPHERE, "top", size, scale=layout.scale))
    left = layout.left(1, 2)
    assert (pixels[layout.top(0) : layout.top(0) + size[1], left : left + size[0]] == alone).all()


def test_equal_scales_share_their_limits() -> None:
    shared = ColorScale("depth", percentiles=(0.0, 100.0))
    scales = fitted_scales([SurfaceView(SPHERE, Z, scale=shared), SurfaceView(SPHERE, 5.0 * Z, scale=shared)])
    assert scales[shared].limits == (-5.0, 5.0)


def test_bars_have_the_limits_ticks_and_label_of_their_scale() -> None:
    views = [SurfaceView(SPHERE, 127.0 + 100.0 * Z, scale=GREY), SurfaceView(SPHERE, 0.3 * Z, scale=DIFFERENCE)]
    scales = fitted_scales(views)
    layout = arrange([views], 1000, False, round(BAR_BAND * text_size(1000)), 0.0)
    with canvas(1000, layout.height) as figure:
        draw_bars(figure, layout, [views], scales)
        pixels = drawn(figure)
        grey, difference = figure.axes
        assert grey.get_xlim() == (0.0, 255.0) and difference.get_xlim() == scales[DIFFERENCE].limits
        ticks = {tick: text.get_text() for tick, text in zip(grey.get_xticks(), grey.get_xticklabels(), strict=True)}
        assert {tick: text for tick, text in ticks.items() if 0 <= tick <= 255} == {0: "0", 100: "100", 200: "200"}
        assert grey.get_xlabel() == "grey value"
        assert re.fullmatch(r"residual \(mm\)\n[\d.]+ % of the values lie beyond", difference.get_xlabel())
        # the colour above each tick is the colour of its value
        for axes, scale in ((grey, GREY), (difference, scales[DIFFERENCE])):
            row = layout.height - round(float(axes.bbox.y0 + axes.bbox.y1) / 2.0)
            inner = [tick for tick in axes.get_xticks() if 0.02 < scale.position(tick) < 0.98]
            assert len(inner) >= 2
            for tick in inner:
                column = int(axes.transData.transform((tick, 0.0))[0])
                assert np.abs(pixels[row, column] - 255.0 * scale.rgb(tick)).max() < 8.0


@pytest.mark.parametrize("width", [300, 500, 800, 1600])
@pytest.mark.parametrize("reach", [0.47, 47.0, 4700.0])
def test_numbers_of_a_bar_do_not_run_together(width: int, reach: float) -> None:
    views = [SurfaceView(SPHERE, reach * Z, scale=ColorScale("depth", limits=(-reach, reach)))]
    layout = arrange([views], width, False, round(BAR_BAND * text_size(width)), 0.0)
    with canvas(width, layout.height) as figure:
        draw_bars(figure, layout, [views], fitted_scales(views))
        drawn(figure)
        (bar,) = figure.axes
        shown = zip(bar.get_xticks(), bar.get_xticklabels(), strict=True)
        boxes = sorted((one.get_window_extent().x0, one.get_window_extent().x1) for t, one in shown if abs(t) <= reach)
    assert len(boxes) >= 2
    assert all(after[0] - before[1] > 2.0 for before, after in pairwise(boxes))


def test_each_bar_is_under_the_views_that_use_it() -> None:
    views = [SurfaceView(SPHERE, 100.0 * Z, scale=GREY)] * 3 + [SurfaceView(SPHERE, Z, scale=DIFFERENCE)]
    layout = arrange([views], 1200, False, round(BAR_BAND * text_size(1200)), 0.0)
    with canvas(1200, layout.height) as figure:
        draw_bars(figure, layout, [views], fitted_scales(views))
        centers = [axes.get_position().x0 + 0.5 * axes.get_position().width for axes in figure.axes]
    assert centers == pytest.approx([layout.middle(1, 4), layout.middle(3, 4)])


@pytest.mark.parametrize("width", [600, 1000, 1600])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 6, 7, 9])
@pytest.mark.parametrize("label", ["depth", "residual of the denoised map"])
def test_words_below_the_bars_do_not_run_together(width: int, count: int, label: str) -> None:
    scales = [ColorScale(f"{label} {k}", "mm", limits=(-0.5, 0.5)) for k in range(count)]
    views = [SurfaceView(SPHERE, Z, scale=scale) for scale in scales]
    grid = [views[first : first + 3] for first in range(0, count, 3)]
    fitted = fitted_scales(views)
    layout = arrange(grid, width, False, bars_height(fitted, views, width, text_size(width)), 0.0)
    with canvas(width, layout.height) as figure:
        draw_bars(figure, layout, grid, fitted)
        drawn(figure)
        boxes = [axes.get_tightbbox() for axes in figure.axes]
    assert len(boxes) == count
    for k, one in enumerate(boxes):
        assert one.x0 >= 0.0 and one.x1 <= width and one.y0 >= 0.0 and one.y1 <= layout.foot
        assert not any(one.overlaps(other) for other in boxes[k + 1 :])


def test_grid_bands_do_not_overlap_and_short_rows_are_centred() -> None:
    views = [[SurfaceView(SPHERE, title="a")] * 3, [SurfaceView(HALF)]]
    layout = arrange(views, 900, True, 0, 0.0)
    assert layout.top(1) >= layout.top(0) + layout.rows[0]
    assert layout.height == layout.top(1) + layout.rows[1]
    assert layout.middle(0, 1) == pytest.approx(0.5, abs=1e-3)
    assert surface_panel(views, width=900, title="grid").pixels.shape == (layout.height, 900, 3)


def test_clipping_and_missing_values_are_said() -> None:
    values = 127.5 + 255.0 * Z
    values[:5] = np.nan
    figure = surface_panel([SurfaceView(SPHERE, values, scale=GREY, title="noisy")], width=300)
    beyond = np.mean((values[5:] < 0.0) | (values[5:] > 255.0))
    assert (
        figure.caption
        == f"{100 * beyond:.2g} % of the values lie beyond the bar 'grey value' and take its end colours."
    )
    assert figure.notes[0] == "5 vertices of 'noisy' have no value; their faces are drawn grey."
    assert surface_panel([SurfaceView(SPHERE)], width=300).notes == ()


@pytest.mark.parametrize("count", [48, 49])
def test_labels_without_a_legend_are_counted(count: int) -> None:
    keys = np.arange(len(SPHERE.vertices)) % count
    notes = surface_panel([SurfaceView(SPHERE, labels=labelling(keys))] * 2, width=300).notes
    assert notes == (() if count <= 48 else ("49 labels are drawn without their names, a legend holds 48.",))


def test_a_bar_says_that_values_were_clipped_before() -> None:
    values = np.clip(Z, -0.4, 0.4)
    clipped = ColorScale("curvature", colormap="RdBu_r", clipped=True)
    share = 100.0 * np.mean(np.abs(Z) >= 0.4)
    for scale, said in ((clipped, f"{share:.2g} % of the values were clipped"), (replace(clipped, clipped=False), "")):
        views = [SurfaceView(SPHERE, values, scale=scale)]
        layout = arrange([views], 800, False, round(BAR_BAND * text_size(800)), 0.0)
        with canvas(800, layout.height) as figure:
            draw_bars(figure, layout, [views], fitted_scales(views))
            (bar,) = figure.axes
            assert bar.get_xlabel() == "\n".join(filter(None, ["curvature", said]))
            assert bar.get_xlim() == (-0.4, 0.4)
            # an end that is pointed is a patch beyond the limits
            assert len(bar.patches) == (2 if said else 0)


def test_bytes_do_not_depend_on_the_users_settings() -> None:
    views = [SurfaceView(SPHERE, Z, title="sphere")]
    before = surface_panel(views, width=300).pixels
    with matplotlib.rc_context({"figure.facecolor": "red", "xtick.direction": "in", "font.family": "serif"}):
        after = surface_panel(views, width=300).pixels
    assert (before == after).all()


@pytest.mark.parametrize("views", [[], [[]], [[SurfaceView(SPHERE)], []]])
def test_panel_without_views_is_refused(views: list) -> None:
    with pytest.raises(ValueError, match="at least 1 view"):
        surface_panel(views)
