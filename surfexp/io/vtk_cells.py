"""Cells of VTK's data sets as polygons."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.io.polygons import triangles_of_strips

TRIANGLE, STRIP, POLYGON, PIXEL, QUAD = 5, 6, 7, 8, 9
CURVES = {0: "empty cells", 1: "vertices", 2: "vertices", 3: "lines", 4: "lines"}


def polygons_of_cells(
    cells: Sequence[Sequence[int]], kinds: Sequence[int]
) -> tuple[list[Sequence[int]], tuple[str, ...]]:
    """Return the polygons of an unstructured grid, strips cut into triangles, and what was passed over.

    Parameters
    ----------
    cells : sequence of sequences of int
    kinds : sequence of int
        VTK's number of each cell's type: 5 triangle, 6 strip, 7 polygon, 8 pixel, 9 quadrangle.

    Raises
    ------
    ValueError
        If there are not as many types as cells, or a cell is a volume or curved.
    """
    if len(cells) != len(kinds):
        raise ValueError(f"it has {len(kinds)} types of cells for {len(cells)} cells")
    polygons: list[Sequence[int]] = []
    passed: dict[str, int] = {}
    for cell, kind in zip(cells, kinds, strict=True):
        if kind in (TRIANGLE, POLYGON, QUAD):
            polygons.append(cell)
        elif kind == PIXEL and len(cell) == 4:
            polygons.append([cell[0], cell[1], cell[3], cell[2]])
        elif kind == STRIP:
            polygons += triangles_of_strips([cell]).tolist()
        elif kind in CURVES:
            passed[CURVES[kind]] = passed.get(CURVES[kind], 0) + 1
        else:
            raise ValueError(
                f"it holds cells of VTK's type {kind}, triangles and polygons are needed: extract the surface first, "
                "as ParaView's Extract Surface does"
            )
    return polygons, passed_over(passed)


def passed_over(counts: dict[str, int]) -> tuple[str, ...]:
    """Say which cells are no surface."""
    named = " and ".join(f"{count} {name}" for name, count in counts.items() if count)
    return (f"{named} are passed over.",) if named else ()


def maps_passed_over(names: Iterable[str]) -> tuple[str, ...]:
    """Say which maps are of cells, where a map of a surface has a row for each vertex."""
    listed = ", ".join(names)
    return (f"Maps of cells are passed over: {listed}.",) if listed else ()


def triangles(strips: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the triangles of strips as polygons."""
    found: Integers = triangles_of_strips(strips)
    listed: list[list[int]] = np.asarray(found).tolist()
    return listed
