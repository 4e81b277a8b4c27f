"""Legacy VTK polygonal data (.vtk, ASCII and binary), for ParaView and its relatives.

By hand: meshio 5.3 reads no POLYDATA and ends the process when it meets one; the vtk package has over 100 MB.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.map_names import names_without_spaces
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.polygons import polygons_between, triangulate
from surfexp.mesh.triangle_mesh import TriangleMesh

TYPES = {"float": "f4", "double": "f8", "int": "i4", "long": "i8", "vtktypeint64": "i8", "vtktypeint32": "i4"}
TYPES |= {"unsigned_char": "u1", "char": "i1", "short": "i2", "unsigned_short": "u2", "unsigned_int": "u4"}


def write_vtk(path: Path, mesh: TriangleMesh, scalars: dict[str, Floats] | None = None) -> None:
    """Write legacy ASCII polygonal data with one SCALARS block for each map (or channel)."""
    n, m = len(mesh.vertices), len(mesh.faces)
    lines = ["# vtk DataFile Version 3.0", path.stem, "ASCII", "DATASET POLYDATA", f"POINTS {n} double"]
    lines += [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"POLYGONS {m} {4 * m}", *(f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist())]
    if scalars:
        lines.append(f"POINT_DATA {n}")
    channels = scalar_channels(scalars or {})
    for name, values in zip(names_without_spaces(channels), channels.values(), strict=True):
        lines += [f"SCALARS {name} double 1", "LOOKUP_TABLE default", *map(repr, values.tolist())]
    path.write_text("\n".join(lines) + "\n")


class _Words:
    """A legacy file read piece by piece: lines of words, then numbers as text or big-endian bytes."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0
        head = [self.line() for _ in range(3)]
        version = re.match(r"# vtk datafile version (\d{1,3})\.", head[0], re.I)
        if not version or head[2].upper() not in ("ASCII", "BINARY"):
            raise ValueError("it has no header of a legacy VTK file")
        self.major, self.binary = int(version[1]), head[2].upper() == "BINARY"

    def line(self) -> str:
        """Return the next line that is not empty, or nothing at the end."""
        while self.at < len(self.data):
            stop = self.data.find(b"\n", self.at)
            stop = len(self.data) if stop < 0 else stop
            line, self.at = self.data[self.at : stop].decode("latin-1").strip(), stop + 1
            if line:
                return line
        return ""

    def numbers(self, count: int, kind: str) -> NDArray[np.generic]:
        """Return the next `count` numbers of a type."""
        if kind.lower() not in TYPES:
            raise ValueError(f"it has numbers of type {kind[:20]!r}, known are {', '.join(TYPES)}")
        dtype = np.dtype(TYPES[kind.lower()])
        if count < 0 or count * (dtype.itemsize if self.binary else 2) > len(self.data) - self.at + 1:
            raise ValueError(f"it ends before {count} numbers that it announces")
        if self.binary:
            found = np.frombuffer(self.data, dtype.newbyteorder(">"), count, self.at)
            self.at += count * dtype.itemsize
            return found.astype(dtype)
        words: list[str] = []
        while len(words) < count:
            line = self.line()
            if not line:
                raise ValueError(f"it ends after {len(words)} of {count} numbers")
            words += line.split()
        if len(words) > count:
            raise ValueError(f"it has {len(words)} numbers where {count} are announced")
        return np.array(words, dtype=np.float64).astype(dtype)

    def named(self, name: str, count: int) -> list[int]:
        """Return `count` whole numbers behind a line with this name and their type."""
        line = self.line().split()
        if len(line) != 2 or line[0].upper() != name:
            raise ValueError(f"it has {' '.join(line)[:40]!r} where {name} and a type are needed")
        return self.numbers(count, line[1]).astype(np.int64).tolist()


def read_vtk(path: Path) -> tuple[Floats, Integers, dict[str, Floats]]:
    """Points, polygons and point data (SCALARS and FIELD arrays) of legacy polygonal data.

    Raises
    ------
    ValueError
        If it is another data set, or ends early.
    """
    words = _Words(path.read_bytes())
    kind = words.line().split()
    if [word.upper() for word in kind] != ["DATASET", "POLYDATA"]:
        raise ValueError(f"it holds {' '.join(kind)[:40]!r}, polygons are needed: DATASET POLYDATA")
    points, polygons, maps, at_points = np.zeros((0, 3)), np.zeros((0, 3), np.int64), dict[str, Floats](), False
    seen: set[str] = set()
    while line := words.line().split():
        key = line[0].upper()
        if key in ("POINTS", "POLYGONS") and key in seen:
            raise ValueError(f"it has {key} twice, one is read: merge them")
        seen.add(key)
        if key == "POINTS" and len(line) == 3:
            points = words.numbers(3 * int(line[1]), line[2]).reshape(-1, 3).astype(np.float64)
        elif key in ("POLYGONS", "VERTICES", "LINES") and len(line) == 3:
            cells = _cells(words, int(line[1]), int(line[2]))
            polygons = triangulate(cells) if key == "POLYGONS" else polygons
        elif key == "TRIANGLE_STRIPS":
            raise ValueError("it holds triangle strips, which only PLY files may have here: write polygons")
        elif key in ("POINT_DATA", "CELL_DATA"):
            at_points = key == "POINT_DATA"
        elif key == "SCALARS" and len(line) >= 3:
            width = int(line[3]) if len(line) > 3 else 1
            words.line()
            _keep(maps, at_points, line[1], words.numbers(width * len(points), line[2]), width)
        elif key == "FIELD" and len(line) == 3:
            for _ in range(int(line[2])):
                name, channels, count, field_kind = words.line().split()
                numbers = words.numbers(int(channels) * int(count), field_kind)
                _keep(maps, at_points, name, numbers, int(channels))
        elif key not in ("METADATA", "INFORMATION", "NAME", "DATA"):
            raise ValueError(f"it has the statement {' '.join(line)[:40]!r}, which is not known here")
    return points, polygons, maps


def _keep(maps: dict[str, Floats], at_points: bool, name: str, values: NDArray[np.generic], width: int) -> None:
    if at_points:
        columns = values.astype(np.float64).reshape(-1, width)
        maps[name] = columns[:, 0].copy() if width == 1 else columns


def _cells(words: _Words, count: int, size: int) -> list[Sequence[int]]:
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
