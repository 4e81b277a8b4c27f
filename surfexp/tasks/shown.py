"""What pictures and views show: surfaces with a map, labels and lines, seen from named sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.drawings.skeleton_drawing import skeleton_lines
from surfexp.extras import require_installed
from surfexp.figures.camera import HEMISPHERE_VIEWS, VIEWS, View, viewing_direction
from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.labelling import Labelling, border_lines
from surfexp.figures.lines import Lines
from surfexp.figures.render import CLAY, SurfaceView
from surfexp.figures.typography import INK
from surfexp.mesh.coloured_labels import Colour
from surfexp.mesh.given_numbers import one_of, real_number, real_pair
from surfexp.mesh.length_scale import length_scale
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.surface_part import Mask
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_colours import as_shares
from surfexp.skeleton.skeleton import Skeleton
from surfexp.tasks.default_view import standing
from surfexp.tasks.drawn_labels import drawn_labels, known_labels, maps_apart, own_label_colors
from surfexp.tasks.given_map import as_map, name_of
from surfexp.tasks.given_surface import as_surface, is_mesh, sides_of
from surfexp.tasks.map_columns import MOST_COLUMNS, own_colors
from surfexp.tasks.map_rows import rows_of_maps
from surfexp.tasks.shown_colors import (
    INSIDE,
    Rows,
    in_shared_colors,
    labels_in_shared_colors,
    scale_of,
    unit_of,
    whole_range,
)
from surfexp.tasks.soundness import usable_vertices


def shown_surfaces(
    surface: Any,
    values: Any = None,
    *,
    views: Sequence[View] | View | None = None,
    colormap: str | None = None,
    limits: tuple[float, float] | None = None,
    contours: ArrayLike | None = None,
    borders: Any = None,
    skeleton: Skeleton | None = None,
    label: str = "",
    unit: str = "",
    most_columns: int = MOST_COLUMNS,
) -> Rows:
    """Return one row for each map, and in it each surface from each side, as `plot` describes its arguments.

    Raises
    ------
    ValueError
        If a map does not fit, or a name is unknown.
    """
    require_installed("sx.plot", "matplotlib", "PIL")
    limits = None if limits is None else real_pair(limits, "limits")
    if limits is not None and not limits[0] < limits[1]:
        raise ValueError(f"limits = {limits}, the lower one before the upper one is needed")
    if colormap is not None:
        from matplotlib import colormaps

        one_of(colormap, "colormap", colormaps)
    if skeleton is not None and not isinstance(skeleton, Skeleton):
        raise TypeError(f"skeleton is a result of sx.reeb_graph, not {type(skeleton).__name__}")
    levels = () if contours is None else tuple(real_number(level, "contours") for level in np.atleast_1d(contours))
    given = [views] if isinstance(views, str) else views or ()
    chosen = [_checked_view(view) for view in given]
    surfaces = [as_surface(one) for one in (surface if is_several(surface) else [surface])]
    scale = max(length_scale(one.mesh.vertices) for one in surfaces)
    if scale != 1.0:
        surfaces = [replace(one, mesh=TriangleMesh(one.mesh.vertices / scale, one.mesh.faces)) for one in surfaces]
        skeleton = None if skeleton is None else skeleton.in_length(1.0 / scale)
    rows: Rows = []
    told: dict[ColorScale, str | None] = {}
    own: dict[str, Colour] = {}
    given_rows = rows_of_maps(values, surfaces, most_columns)
    in_one = skeleton is not None or any(made.skeleton is not None for made in given_rows)
    shown = surfaces if in_one else apart(surfaces)
    for made in given_rows:
        row = []
        maps, outlined = list(made.maps), [known_labels(owner, borders) for owner in surfaces]
        if not in_one:
            maps, outlined = maps_apart(surfaces, maps), maps_apart(surfaces, outlined)
        bases = [_coloured(owner, one) for owner, one in zip(shown, maps, strict=True)]
        for owner, one in zip(shown, maps, strict=True):
            own = own_label_colors(owner, one) | own
        ends = limits or made.limits or whole_range([base.values for base in bases if base.is_scalar])
        for owner, one, base, border in zip(shown, maps, bases, outlined, strict=True):
            called = label or made.bar.strip() or ("" if made.bar else made.name) or _called(one)
            if base.is_scalar:
                known = unit or (unit_of(owner, made.quantity) if made.quantity else "")
                base = replace(base, scale=scale_of(owner, called, known, ends))
                told[base.scale] = colormap or made.colormap
            drawn = _lines(owner, base, levels or made.levels, border, skeleton or made.skeleton)
            row += [
                replace(base, view=_direction(view, owner), contours=drawn, title=_title(view, owner, shown))
                for view in chosen or _default_views(owner)
            ]
        if len(given_rows) > 1 and made.name:
            alone = len(row) == 1
            row[0] = replace(row[0], title=made.name if alone else f"{made.name}: {row[0].title}")
        rows.append(row)
    rows = labels_in_shared_colors(in_shared_colors(rows, told), own)
    if len(rows) == 1 and len(rows[0]) == 1:
        rows = [[replace(rows[0][0], title="")]]
    of_brain = any(one.hemisphere for one in shown)
    return rows if chosen or of_brain else standing(rows, shown[0])


def apart(surfaces: Sequence[Surface]) -> list[Surface]:
    """Return surfaces that are both hemispheres as two, and others as they are."""
    return [one for surface in surfaces for one in surface.hemispheres().values()]


def sides(surface: Surface) -> dict[str, tuple[float, float]]:
    """Return the lateral and medial direction of a hemisphere; none of another surface."""
    return {name: _direction(name, surface) for name in HEMISPHERE_VIEWS} if surface.hemisphere in HEMISPHERES else {}


def _called(given: Any) -> str:
    return name_of(given) if isinstance(given, str | Path) else ""


def is_several(given: Any) -> bool:
    """Whether a list of surfaces is given, and not a pair (vertices, faces)."""
    if not isinstance(given, list | tuple) or not given:
        return False
    first = given[0]
    return len(given) != 2 or isinstance(first, str | Path) or is_mesh(first) or sides_of(first, "mesh") is not None


def _drawable(mesh: TriangleMesh) -> tuple[TriangleMesh, Mask]:
    """Return a mesh in which every vertex has its number and a place, and which of them are corners of whole faces.

    One that is none has the place of another.
    """
    usable = usable_vertices(mesh)
    if usable.all():
        return mesh, usable
    faces = mesh.faces[usable[mesh.faces].all(axis=1)]
    corners = np.zeros_like(usable)
    corners[faces] = True
    return TriangleMesh(np.where(corners[:, None], mesh.vertices, mesh.vertices[np.argmax(corners)]), faces), corners


def _coloured(owner: Surface, given: Any) -> SurfaceView:
    """Return the surface with its map, or labels, without a scale; nothing stands where there is no face."""
    mesh, inside = _drawable(owner.mesh)
    inside = inside if owner.mask is None else inside & owner.mask
    found = drawn_labels(owner, given)
    given = own_colors(owner) if given is None else given
    if found is None and given is None and owner.mask is not None:
        found = Labelling(np.where(owner.mask, 0, -1), (INSIDE,), np.array([CLAY]))
    if found is not None:
        return SurfaceView(mesh, labels=replace(found, index=np.where(inside, found.index, -1)))
    if given is None:
        return SurfaceView(mesh)
    field = as_map(owner, getattr(given, "values", given))
    field = field[:, 0] if field.shape[1:] == (1,) else field
    field = np.where(np.reshape(inside, (-1, *[1] * (field.ndim - 1))), field, np.nan)
    return SurfaceView(mesh, as_shares(field) if field.ndim > 1 else field)


def _lines(
    owner: Surface, base: SurfaceView, levels: tuple[float, ...], outlined: Any, skeleton: Skeleton | None
) -> tuple[Contours | Lines, ...]:
    """Return the borders of labels, the level lines of the map, and the skeleton, one over the other."""
    found: list[Contours | Lines] = []
    if base.labels is not None and len(base.labels.names) > 1:
        found.append(border_lines(base.mesh, base.labels.index))
    if outlined is not None:
        regions = drawn_labels(owner, outlined)
        if regions is None:
            raise ValueError(f"borders = {outlined!r}: give labels by name, a LabelMap, whole numbers or texts")
        found.append(border_lines(base.mesh, regions.index))
    if levels:
        if not base.is_scalar or base.values is None:
            raise ValueError("contours are levels of a map of one channel: give one")
        found.append(Contours(base.values, levels, INK, 1.6, casing=0.8))
    return (*found, *(() if skeleton is None else skeleton_lines(skeleton)))


def _checked_view(given: Any) -> View:
    if given is None or isinstance(given, str | int | float):
        return one_of(given, "views", (*VIEWS, *HEMISPHERE_VIEWS))
    return real_pair(given, "views")


def _default_views(owner: Surface) -> tuple[View, ...]:
    return HEMISPHERE_VIEWS if owner.hemisphere in HEMISPHERES else ("oblique",)


def _direction(view: View, owner: Surface) -> tuple[float, float]:
    """Return azimuth and elevation; the side of a hemisphere is what its file says, not where it lies."""
    if owner.hemisphere in HEMISPHERES and view in HEMISPHERE_VIEWS:
        return VIEWS["left" if (owner.hemisphere == "left") == (view == "lateral") else "right"]
    return viewing_direction(view, owner.mesh)


def _title(view: View, owner: Surface, surfaces: Sequence[Surface]) -> str:
    side = view if isinstance(view, str) else f"{view[0]:g}°, {view[1]:g}°"
    if len(surfaces) == 1:
        return side
    name = owner.hemisphere if len({one.hemisphere for one in surfaces}) == len(surfaces) else owner.name
    return f"{name}, {side}" if owner.hemisphere else name
