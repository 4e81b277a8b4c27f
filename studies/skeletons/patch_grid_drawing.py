"""Pictures of the parametrisation by level sets: its lines and a test on a patch, and the same unrolled."""

from __future__ import annotations

from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.camera import View, unit_camera
from surfexp.figures.figure import Figure
from surfexp.figures.typography import INK, QUIET, canvas, drawn, points
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.parametrization import LevelSetParametrization

FIRST, SECOND, FOUND = "#b2182b", "#2166ac", "#111111"


def grid_panel(
    mesh: TriangleMesh,
    grid: LevelSetParametrization,
    places: tuple[Floats, Floats],
    statistic: Floats,
    found: np.ndarray,
    means: tuple[Floats, Floats],
    *,
    names: tuple[str, str],
    quantity: str,
    view: View = "top",
    width: int = 1500,
    caption: str = "",
) -> Figure:
    """Grid lines and t on a patch, and the means and t over (u, v), with what is found outlined.

    Parameters
    ----------
    mesh : TriangleMesh
        The patch that is drawn.
    grid : LevelSetParametrization
        Of the patch, with K contours.
    places : (K,), (M,) float64
        u and v of the group.
    statistic, found : (K, M) or (K, 1)
        t, and where a difference is found.
    means : two of (K, M) or (K, 1) float64
    names : (str, str)
        Of the two groups.
    quantity : str
        What the map is.
    """
    camera = unit_camera(mesh, view)
    screen = camera.project(grid.points.reshape(-1, 3))[0].reshape(*grid.points.shape[:2], 2)
    edge = camera.project(mesh.vertices)[0][mesh.edges[mesh.edge_face_counts == 1]]
    most = float(np.abs(statistic).max())
    span = np.ptp(edge.reshape(-1, 2), axis=0)
    tall = int(np.clip(0.55 * width * span[1] / span[0], 0.2 * width, 0.5 * width)) + 60
    with canvas(width, tall + 40) as figure:
        left = figure.add_axes((0.01, 0.14, 0.53, 0.76))
        spread = np.stack([np.interp(grid.v, places[1], row) for row in statistic])
        image = _draw_patch(left, screen, edge, spread, most)
        left.set_title(f"level-set grid and t of {quantity}", fontsize=points(0.013 * width))
        bar = figure.colorbar(image, cax=figure.add_axes((0.17, 0.07, 0.2, 0.02)), orientation="horizontal")
        bar.ax.tick_params(labelsize=points(0.009 * width))
        if statistic.shape[1] == 1:
            axes = figure.add_axes((0.61, 0.16, 0.36, 0.70))
            _draw_curves(axes, places[0], means, found[:, 0], names, quantity, width)
        else:
            _draw_maps(figure, places, statistic, found, means, names, most, width)
        pixels = drawn(figure)
    return Figure(pixels, caption, quantity)


def _draw_patch(axes: Any, screen: Floats, edge: Floats, statistic: Floats, most: float) -> Any:
    from matplotlib.collections import LineCollection

    image = axes.pcolormesh(
        screen[:, :, 0], screen[:, :, 1], statistic, shading="gouraud", cmap="RdBu_r", vmin=-most, vmax=most
    )
    for lines, color, thickness in ((screen, QUIET, 0.7), (screen.transpose(1, 0, 2), QUIET, 0.7), (edge, INK, 1.2)):
        axes.add_collection(LineCollection(list(lines), colors=color, linewidths=thickness))
    low, high = edge.reshape(-1, 2).min(axis=0), edge.reshape(-1, 2).max(axis=0)
    pad = 0.02 * float((high - low).max())
    axes.set_xlim(low[0] - pad, high[0] + pad)
    axes.set_ylim(high[1] + pad, low[1] - pad)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return image


def _draw_curves(
    axes: Any,
    u: Floats,
    means: tuple[Floats, Floats],
    found: np.ndarray,
    names: tuple[str, str],
    label: str,
    width: int,
) -> None:
    size = points(0.011 * width)
    for values, color, name in zip(means, (FIRST, SECOND), names, strict=True):
        axes.plot(u, values[:, 0], color=color, label=name)
    top = axes.get_ylim()[1]
    if found.any():
        axes.plot(u[found], np.full(int(found.sum()), top), "s", color=FOUND, markersize=4, label="found")
    axes.set_xlabel("u, share of the skeleton", fontsize=size)
    axes.set_ylabel(f"{label}, mean", fontsize=size)
    axes.tick_params(labelsize=size)
    axes.legend(fontsize=size, frameon=False)


def _draw_maps(
    figure: Any,
    places: tuple[Floats, Floats],
    statistic: Floats,
    found: np.ndarray,
    means: tuple[Floats, Floats],
    names: tuple[str, str],
    most: float,
    width: int,
) -> None:
    low, high = min(float(m.min()) for m in means), max(float(m.max()) for m in means)
    rows = [
        (f"mean, {names[0]}", means[0], "viridis", (low, high)),
        (f"mean, {names[1]}", means[1], "viridis", (low, high)),
        ("t; outlined: found after correction", statistic, "RdBu_r", (-most, most)),
    ]
    size = points(0.011 * width)
    for k, (title, values, colors, limits) in enumerate(rows):
        axes = figure.add_axes((0.60, 0.70 - 0.285 * k, 0.33, 0.18))
        image = axes.pcolormesh(
            *places, values.T, shading="nearest", cmap=colors, vmin=limits[0], vmax=limits[1], rasterized=True
        )
        if k == 2 and found.any():
            axes.contour(*places, found.T.astype(float), [0.5], colors=FOUND, linewidths=1.5)
        axes.grid(False)
        axes.set_title(title, fontsize=size)
        axes.set_ylabel("v", fontsize=size)
        axes.tick_params(labelsize=0.9 * size)
        if k == 2:
            axes.set_xlabel("u, share of the skeleton", fontsize=size)
        bar = figure.add_axes((0.945, 0.70 - 0.285 * k, 0.012, 0.18))
        figure.colorbar(image, cax=bar).ax.tick_params(labelsize=0.8 * size)
