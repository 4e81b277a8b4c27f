"""What a surface in a page can be coloured by: images, results, residuals, modes, features, each with its lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.drawings.skeleton_drawing import LEVELS, skeleton_lines
from surfexp.figures.boundary_line import without_rim
from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import RED, Contours
from surfexp.figures.labelling import labelling
from surfexp.figures.lines import CASING, Lines
from surfexp.figures.typography import INK
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.skeleton import Skeleton
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution
from surfexp.viewer.scene import Field, Step

# modes that a page holds of each surface, and levels of each feature that it draws
MODES, LEVELS_DRAWN = 21, 60


def image_fields(mesh: TriangleMesh, image: Image, solution: Solution | None, colormap: str) -> list[Field]:
    """Clean and observed image, then result and residual, or the regions, in the scales of the figures."""
    observed = np.array(image.values, dtype=np.float64)
    if image.known is not None:
        observed[~image.known] = np.nan
    shown = {"image": observed} if image.clean is None else {"clean": image.clean, "image": observed}
    scale = ColorScale(image.name, image.unit, colormap)
    if solution is not None and solution.segmentation is not None:
        lines = _boundaries(mesh, solution)
        regions = labelling(np.asarray(solution.segmentation, dtype=np.int64))
        images = [one for name, values in shown.items() for one in _by_channel(name, values, scale, lines)]
        return [*images, Field("regions", (Step(regions.values, "", lines),), labels=regions)]
    if solution is None or solution.values.shape != observed.shape:
        return [one for name, values in shown.items() for one in _by_channel(name, values, scale)]
    shown["result"] = solution.values
    whole = replace(scale, percentiles=(0.0, 100.0)).fitted(solution.values if image.clean is None else image.clean)
    spread = (-2.5 * image.noise, 2.5 * image.noise) if image.noise else None
    residual = _by_channel("residual", observed - solution.values, ColorScale("residual", image.unit, "RdBu_r", spread))
    return [*(one for name, values in shown.items() for one in _by_channel(name, values, whole)), *residual]


def mode_field(mesh: TriangleMesh, system: EigenSystem) -> Field:
    """The first eigenfunctions in units of their root mean square, with nodal lines, counted from the constant one."""
    steps = []
    for k in range(min(len(system.values), MODES)):
        values = system.area**0.5 * system.vectors[: len(mesh.vertices), k]
        level = values if mesh.is_closed else without_rim(mesh, values)
        name = f"mode {k + (system.boundary == 'dirichlet')}, λ = {system.values[k]:.4g}"
        steps.append(Step(values, name, level_lines(mesh, level, (0.0,), INK)))
    scale = ColorScale("eigenfunction, units of its root mean square", "", "RdBu_r", (-2.0, 2.0))
    return Field("mode", tuple(steps), scale)


def feature_field(mesh: TriangleMesh, feature: Feature, skeleton: Skeleton | None) -> Field:
    """A feature function; with a skeleton made from it, its levels and the graph."""
    lines: tuple[Lines, ...] = ()
    if skeleton is not None:
        every = -(-len(skeleton.levels) // LEVELS_DRAWN) or 1
        lines = (
            *level_lines(mesh, feature.values, skeleton.levels[::every].tolist(), LEVELS, 1.2),
            *skeleton_lines(skeleton),
        )
    return Field(feature.name, (Step(feature.values, "", lines),), ColorScale(feature.name, feature.unit))


def level_lines(
    mesh: TriangleMesh, values: Floats, levels: Sequence[float], color: str, width: float = 2.0, casing: float = 0.0
) -> tuple[Lines, ...]:
    """The lines on which a function takes some levels, as one; none where it takes none."""
    found = Contours(values, tuple(levels), color, width, casing).lines(mesh)
    return (found,) if len(found.segments) else ()


def _by_channel(name: str, values: Floats, scale: ColorScale, lines: tuple[Lines, ...] = ()) -> list[Field]:
    """One field, or one for each channel, of a scale whose limits are then those of its values."""
    if values.ndim == 1:
        return [Field(name, (Step(values, "", lines),), scale)]
    channels = [np.ascontiguousarray(channel) for channel in values.T]
    return [Field(f"{name}, channel {k}", (Step(channel, "", lines),), scale) for k, channel in enumerate(channels, 1)]


def _boundaries(mesh: TriangleMesh, solution: Solution) -> tuple[Lines, ...]:
    """The lines between the regions of a segmentation; none of another solution."""
    if solution.segmentation is None:
        return ()
    labels = np.asarray(solution.segmentation, dtype=np.float64)
    if len(np.unique(labels)) < 3:
        values, level = solution.boundary
        return level_lines(mesh, values, (level,), RED, casing=CASING)
    apart = [
        level_lines(mesh, (labels == label).astype(np.float64), (0.5,), RED, casing=CASING)
        for label in np.unique(labels)[1:]
    ]
    return tuple(line for lines in apart for line in lines)
