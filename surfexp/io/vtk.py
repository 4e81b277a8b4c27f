"""Legacy VTK files of polygons or of an unstructured grid of them (.vtk), for ParaView and its relatives.

By hand: meshio 5.3 reads no POLYDATA and ends the process when it meets one; the vtk package has over 100 MB.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.io.legacy_vtk import LegacyVtk, name_to_word, word_to_name
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.mesh_file import Decoded
from surfexp.io.polygons import polygons_between
from surfexp.io.vtk_cells import maps_passed_over, passed_over, polygons_of_cells, triangles
from surfexp.mesh.triangle_mesh import TriangleMesh

# numbers a point of the attributes that have a fixed width; they are no maps
DIRECTIONS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6}
NUMBERS = ("GLOBAL_IDS", "PEDIGREE_IDS", "EDGE_FLAGS")
# of a name in VTK's own reader
LONGEST_WORD = 255
CELLS = ("POLYGONS", "VERTICES", "LINES", "TRIANGLE_STRIPS", "CELLS")


def write_vtk(path: Path, mesh: TriangleMesh, scalars: dict[str, Floats] | None = None) -> None:
    """Write legacy ASCII polygonal data with one SCALARS block for each map (or channel)."""
    n, m = len(mesh.vertices), len(mesh.faces)
    lines = ["# vtk DataFile Version 3.0", "surfexp", "ASCII", "DATASET POLYDATA", f"POINTS {n} double"]
    lines += [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"POLYGONS {m} {4 * m}", *(f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist())]
    if scalars:
        lines.append(f"POINT_DATA {n}")
    channels = scalar_channels(scalars or {})
    for name, values in channels.items():
        if len(word := name_to_word(name)) > LONGEST_WORD:
            raise ValueError(
                f"map name {name[:20]!r}... has {len(word)} characters, .vtk holds {LONGEST_WORD}: rename the map"
            )
        lines += [f"SCALARS {word} double 1", "LOOKUP_TABLE default", *map(repr, values.tolist())]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def read_vtk(path: Path) -> Decoded:
    """Points, polygons, strips and the maps among point data (SCALARS, VECTORS and FIELD arrays) of a legacy VTK file.

    Normals, colours, texture coordinates, identities and data of cells are passed over by their length; maps of cells are named.

    Raises
    ------
    ValueError
        If it is another data set, holds volumes, or ends early.
    """
    words = LegacyVtk(path.read_bytes())
    kind = words.line().split()
    if [word.upper() for word in kind] not in (["DATASET", "POLYDATA"], ["DATASET", "UNSTRUCTURED_GRID"]):
        raise ValueError(
            f"it holds {' '.join(kind)[:40]!r}, polygons are needed: DATASET POLYDATA or UNSTRUCTURED_GRID"
        )
    points, maps, of_cells = np.zeros((0, 3)), dict[str, Floats](), dict[str, Floats]()
    cells: dict[str, list[Sequence[int]]] = {}
    types: list[int] = []
    rows, at_points = 0, False
    while line := words.line().split():
        key = line[0].upper()
        if key in ("POINTS", "POLYGONS", "CELLS") and (key in cells or (key == "POINTS" and len(points))):
            raise ValueError(f"it has {key} twice, one is read: merge them")
        if key == "POINTS" and len(line) == 3:
            points = words.numbers(3 * int(line[1]), line[2]).reshape(-1, 3).astype(np.float64)
        elif key in CELLS and len(line) == 3:
            cells[key] = _cells(words, int(line[1]), int(line[2]))
        elif key == "CELL_TYPES" and len(line) == 2:
            types = words.numbers(int(line[1]), "int").astype(np.int64).tolist()
        elif key in ("POINT_DATA", "CELL_DATA") and len(line) == 2:
            at_points, rows = key == "POINT_DATA", int(line[1])
            if at_points and rows != len(points):
                raise ValueError(f"its POINT_DATA has {rows} rows for {len(points)} points")
        elif key == "METADATA":
            words.skip_metadata()
        else:
            found = _attribute(words, line, rows)
            (maps if at_points else of_cells).update(found)
    if types or "CELLS" in cells:
        polygons, notes = polygons_of_cells(cells.get("CELLS", []), types)
    else:
        polygons = [*cells.get("POLYGONS", []), *triangles(cells.get("TRIANGLE_STRIPS", []))]
        notes = passed_over({"vertices": len(cells.get("VERTICES", [])), "lines": len(cells.get("LINES", []))})
    return Decoded(points, polygons, maps, (*notes, *maps_passed_over(of_cells)))


def _attribute(words: LegacyVtk, line: list[str], rows: int) -> dict[str, Floats]:
    """Read one attribute of points or cells to its end, and return the maps in it."""
    key = line[0].upper()
    if key == "SCALARS" and len(line) >= 3:
        width = int(line[3]) if len(line) > 3 else 1
        if words.peek()[:1] and words.peek()[0].upper() == "LOOKUP_TABLE" and len(words.peek()) == 2:
            words.line()
        return {word_to_name(line[1]): _columns(words.numbers(width * rows, line[2]), width)}
    if key in DIRECTIONS and len(line) == 3:
        values = _columns(words.numbers(DIRECTIONS[key] * rows, line[2]), DIRECTIONS[key])
        return {word_to_name(line[1]): values} if key == "VECTORS" else {}
    if key in NUMBERS and len(line) == 3:
        words.numbers(rows, line[2])
    elif key == "TEXTURE_COORDINATES" and len(line) == 4:
        words.numbers(int(line[2]) * rows, line[3])
    elif key == "COLOR_SCALARS" and len(line) == 3:
        words.numbers(int(line[2]) * rows, "unsigned_char" if words.binary else "float")
    elif key == "LOOKUP_TABLE" and len(line) == 3:
        words.numbers(4 * int(line[2]), "unsigned_char" if words.binary else "float")
    elif key == "FIELD" and len(line) == 3:
        return _field(words, int(line[2]), rows)
    else:
        raise ValueError(f"it has the statement {' '.join(line)[:40]!r}, which is not known here")
    return {}


def _field(words: LegacyVtk, count: int, rows: int) -> dict[str, Floats]:
    maps: dict[str, Floats] = {}
    for _ in range(count):
        line = words.line().split()
        if line[:1] == ["METADATA"]:
            words.skip_metadata()
            line = words.line().split()
        name, channels, length, kind = line
        width, size = int(channels), int(channels) * int(length)
        if kind.lower() == "string":
            words.skip_strings(size)
            continue
        numbers = words.numbers(size, kind)
        if rows and int(length) == rows and width > 0:
            maps[word_to_name(name)] = _columns(numbers, width)
    return maps


def _columns(values: NDArray[np.generic], width: int) -> Floats:
    columns = values.astype(np.float64).reshape(-1, width)
    return columns[:, 0].copy() if width == 1 else columns


def _cells(words: LegacyVtk, count: int, size: int) -> list[Sequence[int]]:
    """Read cells: each behind its number of corners, or since version 5.1 where each begins, then all corners."""
    if words.major >= 5:
        starts, corners = words.named("OFFSETS", count), words.named("CONNECTIVITY", size)
        return polygons_between(starts, corners)
    flat = words.numbers(size, "int").astype(np.int64).tolist()
    cells: list[Sequence[int]] = []
    at = 0
    for number in range(count):
        stop = at + 1 + flat[at] if at < len(flat) else -1
        if not at < stop <= len(flat):
            raise ValueError(f"cell {number} of {count} is cut short")
        cells.append(flat[at + 1 : stop])
        at = stop
    return cells
