"""Sulcal regions of two cortices in space and in the optimal embedding, figures 6.4 to 6.6."""

import numpy as np
from matplotlib.colors import hsv_to_rgb
from pydantic import Field

from surfexp.embedding.distance import Distance
from surfexp.embedding.sulcal_regions import names_by_majority
from surfexp.figures.figure import Figure
from surfexp.figures.typography import canvas, drawn, points
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import Floats
from surfexp.workflow.registry import Options, register

LABEL = "label"


class EmbeddedRegions(Options):
    """Size and dots."""

    dots: int = Field(4000, ge=100, le=50000, description="most points of each surface that are drawn")
    width: int = Field(1600, ge=400, le=6000, description="pixels across")


@register("figure", "embedded_regions")
def embedded_regions_figure(
    options: EmbeddedRegions, *, source_surface: Surface, target_surface: Surface, distance: Distance
) -> Figure:
    """Regions of two surfaces, in space where poses differ, and in the embedding where like regions meet (6.5)."""
    surfaces = source_surface, target_surface
    missing = [surface.name for surface in surfaces if LABEL not in surface.scalars]
    if missing:
        raise ValueError(f"{missing[0]} has no scalar map 'label': make it with the surface sulcal_regions")
    labels = [surface.scalars[LABEL].astype(int) for surface in surfaces]
    areas = target_surface.mesh.vertex_areas
    names = names_by_majority(labels[1] - 1, areas, labels[0] - 1, distance.correspondence) + 1
    colors = [_colors(labels[0]), _colors(np.concatenate([[0], names])[labels[1]])]
    kept = [_some(label > 0, options.dots) for label in labels]
    around = [_some(label == 0, options.dots) for label in labels]
    clouds = [_principal(surface.mesh.vertices) for surface in surfaces]
    embedded = [distance.source_points[:, :3], distance.target_points[:, :3]]
    em = 0.0135 * options.width
    with canvas(options.width, round(0.33 * options.width)) as figure:
        panels = (("regions of the source", (0,), clouds), ("regions of the target", (1,), clouds))
        for k, (title, members, places) in enumerate((*panels, ("both in the embedding", (0, 1), embedded))):
            axes = figure.add_axes((k / 3, -0.04, 1 / 3, 0.98), projection="3d")
            for member in members:
                if k < 2:
                    axes.scatter(
                        *places[member][around[member]].T, s=4.0, c="#c4c4c4", linewidths=0, alpha=0.6, zorder=0
                    )
                dots = places[member][kept[member]]
                color, marker = colors[member][kept[member]], "o" if member == 0 else "^"
                axes.scatter(*dots.T, s=14.0, c=color, marker=marker, linewidths=0, alpha=0.9, zorder=1)
            everything = np.vstack([places[member] for member in members])
            axes.set_box_aspect(np.ptp(everything, axis=0), zoom=1.55)
            axes.set_axis_off()
            axes.view_init(*((0, -90) if k < 2 else (15, -55)))
            axes.computed_zorder = False
            figure.text((k + 0.5) / 3, 0.94, title, fontsize=points(em), ha="center", va="center")
        pixels = drawn(figure)
    caption = (
        f"Sulcal regions of {source_surface.name} and {target_surface.name}: in space, each along its main axes, and by "
        f"the first three functions of the optimal embedding. Colours of the target are those of the source by majority "
        "vote of the nearest neighbours. Compare figures 6.4 to 6.6."
    )
    return Figure(pixels, caption, "sulcal regions")


def _principal(vertices: Floats) -> Floats:
    """Coordinates along the main axes: the longest across, the second up, the third towards the eye."""
    centred = vertices - vertices.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    axes[2] *= np.linalg.det(axes)
    return np.asarray(centred @ axes[[0, 2, 1]].T)


def _some(inside: np.ndarray, count: int) -> np.ndarray:
    rows = np.flatnonzero(inside)
    return rows if len(rows) <= count else np.random.default_rng(0).permutation(rows)[:count]


def _colors(labels: np.ndarray) -> Floats:
    k = labels.astype(float)
    hues = np.stack([(0.618034 * k) % 1.0, 0.6 + 0.25 * (k % 2), 0.9 - 0.2 * (k % 3 == 2)], axis=1)
    return np.where((labels > 0)[:, None], np.asarray(hsv_to_rgb(hues)), 0.8)
