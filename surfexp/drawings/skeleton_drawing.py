"""Pictures of skeletons: lines over surfaces, one or many on a page at one scale."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.camera import View, fit_camera, projected_extent, unit_camera
from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure
from surfexp.figures.lines import Lines
from surfexp.figures.render import SurfaceView, draw
from surfexp.figures.typography import canvas, drawn, points
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.skeleton import CAP, JUNCTION, Skeleton

LINE, CAPS, JUNCTIONS, LEVELS = "#0b3c7d", "#1a9850", "#f46d43", "#b2182b"


@dataclass(frozen=True, eq=False)
class SkeletonView:
    """A surface with a skeleton over it.

    Parameters
    ----------
    mesh : TriangleMesh
    skeleton : Skeleton, optional
    values : (n,) float64, optional
        In colour, each picture with its own range; clay when None.
    level_field : (n,) float64, optional
        The function whose levels, those of the skeleton, are drawn in red.
    title : str
    """

    mesh: TriangleMesh
    skeleton: Skeleton | None = None
    values: Floats | None = None
    level_field: Floats | None = None
    title: str = ""
    colormap: str = field(default="viridis")


def skeleton_panel(
    views: Sequence[SkeletonView],
    *,
    view: View = "front",
    columns: int = 0,
    width: int = 1400,
    title: str = "",
    caption: str = "",
    most_levels: int = 60,
) -> Figure:
    """Surfaces with their skeletons in a grid, all at one scale.

    Nodes are drawn where they matter: green dots are ends, orange ones junctions.

    Parameters
    ----------
    view : str or (float, float)
        As in `fit_camera`, the same for all.
    columns : int
        In the grid; 0 puts up to three side by side, and more in four columns.
    most_levels : int
        Draw every second, third, ... level if there are more.

    Raises
    ------
    ValueError
        If there is nothing to draw.
    """
    if not views:
        raise ValueError("the panel has 0 skeletons, at least 1 is needed")
    columns = columns or (len(views) if len(views) <= 3 else 4)
    rows = -(-len(views) // columns)
    em, gap = max(0.013 * width, 15.0), 8
    cell = (width - gap * (columns + 1)) // columns
    extents = np.array([projected_extent(unit_camera(item.mesh, view), item.mesh) for item in views])
    scale = 0.94 * cell / max(float(extents[:, 0].max()), 0.75 * float(extents[:, 1].max()))
    height = int(scale * float(extents[:, 1].max()) / 0.94) + 4
    band = int(1.8 * em) if any(item.title for item in views) else 0
    head = int(2.4 * em) if title else 0
    total = head + rows * (height + band + gap) + gap
    page = np.full((total, width, 3), 255, dtype=np.uint8)
    lines: list[tuple[SkeletonView, Any, int, int]] = []
    for i, item in enumerate(views):
        top, left = head + (i // columns) * (height + band + gap) + band, gap + (i % columns) * (cell + gap)
        camera = fit_camera(item.mesh, view, (cell, height), scale=scale)
        page[top : top + height, left : left + cell] = draw(_scene(item, view, most_levels, cell), camera)
        lines.append((item, camera, top, left))
    with canvas(width, total) as figure:
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.imshow(page, interpolation="nearest", extent=(0, width, total, 0))
        axes.set_axis_off()
        for item, camera, top, left in lines:
            _draw_skeleton(axes, item, camera, top, left, cell)
            if item.title:
                axes.text(
                    left + 0.5 * cell, top - 0.5 * band, item.title, fontsize=points(em), ha="center", va="center"
                )
        if title:
            axes.text(gap + 4, 0.55 * head, title, fontsize=points(1.15 * em), fontweight="bold", va="center")
        axes.set_xlim(0, width)
        axes.set_ylim(total, 0)
        pixels = drawn(figure)
    return Figure(pixels, caption, title)


def _scene(item: SkeletonView, view: View, most_levels: int, cell: int) -> SurfaceView:
    contours: tuple[Contours, ...] = ()
    if item.level_field is not None and item.skeleton is not None and len(item.skeleton.levels):
        levels = item.skeleton.levels[:: -(-len(item.skeleton.levels) // most_levels)]
        thickness = float(np.clip(cell / 500.0, 0.8, 1.8))
        contours = (Contours(item.level_field, tuple(levels.tolist()), LEVELS, thickness, casing=0.0),)
    return SurfaceView(item.mesh, item.values, view, ColorScale(colormap=item.colormap), contours)


def _draw_skeleton(axes: Any, item: SkeletonView, camera: Any, top: int, left: int, cell: int) -> None:
    from matplotlib.collections import LineCollection

    skeleton = item.skeleton
    if skeleton is None:
        return
    screen = camera.project(skeleton.positions)[0] + (left, top)
    thickness = float(np.clip(cell / 160.0, 1.6, 4.0))
    for color, extra in (("white", 1.5), (LINE, 0.0)):
        axes.add_collection(
            LineCollection(screen[skeleton.arcs], colors=color, linewidths=points(thickness + extra), capstyle="round")
        )
    size = points(float(np.clip(cell / 60.0, 4.5, 11.0)))
    for kind, color in ((CAP, CAPS), (JUNCTION, JUNCTIONS)):
        chosen = screen[skeleton.kinds == kind]
        axes.plot(*chosen.T, "o", color=color, markersize=size, markeredgecolor="white", markeredgewidth=points(1.0))


def skeleton_lines(skeleton: Skeleton, width: float = 3.0) -> list[Lines]:
    """The arcs of a graph on a white casing, and dots where it ends or branches, seen through the surface."""
    positions, arcs = skeleton.positions, skeleton.arcs
    found = [Lines(positions, arcs, LINE, width, through=True, casing=0.5 * width)]
    for kind, color in ((CAP, CAPS), (JUNCTION, JUNCTIONS)):
        nodes = positions[skeleton.kinds == kind]
        # a line with round ends as short as a dot: it needs a direction
        ends = nodes + 1e-4 * np.ptp(positions, axis=0)
        pairs = np.arange(2 * len(nodes)).reshape(2, -1).T
        if len(nodes):
            found.append(Lines(np.concatenate([nodes, ends]), pairs, color, 3.0 * width, through=True))
    return found
