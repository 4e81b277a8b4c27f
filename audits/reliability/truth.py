"""What a file was written to say, what a reader found in it, and where the two differ."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh

SURFACE, MAPS, LABELS, MASK, LIST = "surface", "maps", "labels", "mask", "list"


@dataclass(frozen=True)
class Truth:
    """What a file says.

    Parameters
    ----------
    kind : str
        SURFACE, MAPS, LABELS, MASK or LIST (of vertices): by which door it is read.
    vertices : (n, 3), optional
    polygons : sequence of sequences of int
        In the order of the file.
    maps : dict of str to (n,) or (n, c)
    labels : list of str
        Name of the label of each vertex.
    mask : (n,) bool, optional
    welded : bool
        Whether vertices may be numbered in any way, as in STL.
    refused : str
        A piece of the reason for which the file has to be refused; nothing where it has to be read.
    tolerance : float
        By which numbers may differ, in terms of the largest: what the writer rounds.
    """

    kind: str
    vertices: Floats | None = None
    polygons: Sequence[Sequence[int]] = ()
    maps: dict[str, Floats] = field(default_factory=dict)
    labels: Sequence[str] = ()
    mask: np.ndarray | None = None
    welded: bool = False
    refused: str = ""
    tolerance: float = 0.0


@dataclass(frozen=True)
class Found:
    """What a reader finds: polygons, or triangles that it cut them into.

    Parameters
    ----------
    named : bool
        Whether the reader gives maps their names.
    welds : bool
        Whether corners of triangles at one place are one vertex.
    """

    vertices: Floats | None = None
    polygons: Sequence[Sequence[int]] | None = None
    maps: dict[str, Floats] | None = None
    labels: Sequence[str] | None = None
    mask: np.ndarray | None = None
    named: bool = True
    welds: bool = True


def difference(truth: Truth, found: Found, tolerance: float = 0.0) -> str:
    """Return where what was found differs from what the file says; nothing where it does not.

    What a reader does not tell at all is not compared. Numbers may differ by the larger of the two tolerances.
    """
    truth = replace(truth, tolerance=max(tolerance, truth.tolerance))
    if found.vertices is not None and truth.vertices is not None and found.polygons is not None:
        said = _of_surfaces(truth, found)
        if said:
            return said
    if found.maps is not None:
        said = _of_maps(truth, found)
        if said:
            return said
    if found.labels is not None and list(found.labels) != list(truth.labels):
        wrong = sum(a != b for a, b in zip(found.labels, truth.labels, strict=False))
        return f"{wrong} of {len(truth.labels)} labels differ, {len(found.labels)} found"
    if found.mask is not None and truth.mask is not None and not np.array_equal(found.mask, truth.mask):
        return f"the mask has {int(found.mask.sum())} of {len(found.mask)} inside, not {int(truth.mask.sum())}"
    return ""


def _of_surfaces(truth: Truth, found: Found) -> str:
    assert truth.vertices is not None and found.vertices is not None and found.polygons is not None
    told, seen = [list(p) for p in truth.polygons], [list(map(int, p)) for p in found.polygons]
    if truth.welded:
        corners = [truth.vertices[p] for p in told], [found.vertices[p] for p in seen]
        limit = truth.tolerance * float(np.abs(truth.vertices).max())
        same = len(told) == len(seen) and all(
            a.shape == b.shape and np.abs(a - b).max() <= limit for a, b in zip(*corners, strict=True)
        )
        count = len(np.unique(truth.vertices[np.unique(np.concatenate(told))], axis=0))
        if same and found.welds and len(found.vertices) != count:
            return f"{len(found.vertices)} vertices after welding, not {count}"
        return "" if same else "corners of faces differ"
    if found.vertices.shape != truth.vertices.shape:
        return f"{found.vertices.shape} vertices, not {truth.vertices.shape}"
    size = float(np.nanmax(np.abs(truth.vertices), initial=0.0))
    if not np.allclose(found.vertices, truth.vertices, rtol=0.0, atol=truth.tolerance * size, equal_nan=True):
        return f"vertices differ by {np.nanmax(np.abs(found.vertices - truth.vertices)):g}"
    if Counter(map(_turned, told)) == Counter(map(_turned, seen)):
        return ""
    return _of_cuts(truth.vertices, told, seen)


def _turned(polygon: Sequence[int]) -> tuple[int, ...]:
    """Return a polygon from its smallest corner on."""
    begin = min(range(len(polygon)), key=lambda k: polygon[k])
    return (*polygon[begin:], *polygon[:begin])


def _of_cuts(vertices: Floats, told: list[list[int]], seen: list[list[int]]) -> str:
    """Compare triangles with the polygons that they were cut from, in the order of the file."""
    if any(len(triangle) != 3 for triangle in seen):
        return "polygons differ"
    if len(seen) != sum(len(polygon) - 2 for polygon in told):
        return f"{len(seen)} triangles of polygons that have {sum(len(polygon) - 2 for polygon in told)}"
    at = 0
    for number, polygon in enumerate(told):
        triangles = seen[at : at + len(polygon) - 2]
        at += len(triangles)
        if {corner for triangle in triangles for corner in triangle} != set(polygon):
            return f"polygon {number} is cut into triangles of other corners"
        points = vertices[polygon] - vertices[polygon].mean(axis=0)
        vector = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
        mesh = TriangleMesh(vertices, np.array(triangles, dtype=np.int64))
        size = np.abs(points).max() ** 2
        if not np.allclose(mesh.face_cross_products.sum(axis=0), vector, rtol=1e-9, atol=1e-9 * size):
            return f"polygon {number} is cut into triangles of another orientation or area"
        height = np.abs(points @ vector).max() / max(np.linalg.norm(vector), 1e-300)
        flat = height < 1e-9 * np.sqrt(size)
        if flat and not np.isclose(2.0 * mesh.areas.sum(), np.linalg.norm(vector), rtol=1e-6):
            return f"polygon {number} is flat and its triangles lie over one another"
    return ""


def _of_maps(truth: Truth, found: Found) -> str:
    assert found.maps is not None
    if not found.named:
        told, seen = list(truth.maps.values()), list(found.maps.values())
        if len(told) != len(seen):
            return f"{len(seen)} maps, not {len(told)}"
        pairs = [(str(k), a, b) for k, (a, b) in enumerate(zip(told, seen, strict=True))]
    else:
        if set(truth.maps) != set(found.maps):
            return f"maps {sorted(found.maps)}, not {sorted(truth.maps)}"
        pairs = [(name, values, found.maps[name]) for name, values in truth.maps.items()]
    for name, told_values, seen_values in pairs:
        if told_values.shape != seen_values.shape:
            return f"map {name!r} has shape {seen_values.shape}, not {told_values.shape}"
        size = float(np.nanmax(np.abs(told_values), initial=0.0))
        if not np.allclose(seen_values, told_values, rtol=0.0, atol=truth.tolerance * size, equal_nan=True):
            return f"map {name!r} has other values"
    return ""
