"""The colours of what pictures and views show: one scale for maps of one quantity, one colour for labels of one name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.colormap import ColorScale
from surfexp.figures.labelling import Labelling, label_colors
from surfexp.figures.render import CLAY, SurfaceView
from surfexp.mesh.coloured_labels import Colour
from surfexp.mesh.surface import Surface
from surfexp.tasks.map_colours import CENTRAL, usual_colormap

# FreeSurfer's maps by the end of their names: what they are called, and the power of the length in their unit
FREESURFER = {
    "curv": ("curv (FreeSurfer, + in sulci)", -1),
    "sulc": ("sulc (FreeSurfer, + in sulci)", 0),
    "thickness": ("", 1),
    "area": ("", 2),
}
POWERS = {-1: "1/{}", 0: "", 1: "{}", 2: "{}²"}
INSIDE = "inside the mask"
Rows = list[list[SurfaceView]]


def scale_of(owner: Surface, name: str, unit: str, limits: tuple[float, float] | None) -> ColorScale:
    """Return the scale of a map; FreeSurfer's are named with their sign, in the unit of the surface."""
    called, _ = FREESURFER.get(name.rpartition(".")[2], ("", None))
    return ColorScale(called or name, unit or unit_of(owner, name), limits=limits)


def unit_of(owner: Surface, name: str) -> str:
    """The unit of a map of FreeSurfer's, where that of the surface is known."""
    _, power = FREESURFER.get(name.rpartition(".")[2], ("", None))
    return POWERS[power].format(owner.unit) if power is not None and owner.unit else ""


def whole_range(fields: Sequence[Floats | None]) -> tuple[float, float] | None:
    """The least and the largest value of a map of which nearly all values are the same, as one of p-values."""
    known = np.concatenate([np.empty(0), *(np.ravel(field) for field in fields if field is not None)])
    known = known[np.isfinite(known)]
    if not known.size or not known.min() < known.max():
        return None
    low, high = np.percentile(known, CENTRAL)
    return None if low < high else (float(known.min()), float(known.max()))


def in_shared_colors(rows: Rows, told: dict[ColorScale, str | None]) -> Rows:
    """Return rows in which all maps of one scale have the same colours: those that were told, or what suits all of them."""
    fields: dict[ColorScale, list[Floats]] = {scale: [] for scale in told}
    for view in (view for row in rows for view in row if view.is_scalar):
        if view.values is not None:
            fields[view.scale].append(view.values)
    scales = {
        scale: replace(scale, colormap=told[scale] or usual_colormap(fields[scale], scale.limits)) for scale in told
    }
    return [[replace(view, scale=scales[view.scale]) if view.is_scalar else view for view in row] for row in rows]


def labels_in_shared_colors(rows: Rows, own: Mapping[str, Colour]) -> Rows:
    """Return rows in which labels of one name have one colour: the first that one has of its own, else one of ours."""
    names = dict.fromkeys(name for row in rows for view in row if view.labels for name in view.labels.names)
    free = [name for name in names if name not in own and name != INSIDE]
    chosen = {INSIDE: CLAY, **own, **dict(zip(free, label_colors(len(free)), strict=True))}

    def recoloured(labels: Labelling) -> Labelling:
        colors = [chosen[name] for name in labels.names]
        return replace(labels, colors=np.array(colors, dtype=np.float64).reshape(-1, 3))

    return [[replace(view, labels=recoloured(view.labels)) if view.labels else view for view in row] for row in rows]
