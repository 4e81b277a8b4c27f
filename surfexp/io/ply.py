"""Stanford PLY files, ASCII and binary.

By hand: libigl, which is a dependency, hands on positions and faces alone. Maps, colours and strips of triangles are read here, and
a damaged file is refused with what is wrong in it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.io.map_names import names_without_spaces
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.mesh_file import Decoded
from surfexp.io.polygons import triangles_of_strips
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_colours import ALPHA, COLOURS, are_bytes

TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
}
HEMISPHERE = re.compile(rb"^comment hemisphere (left|right)[ \t]*\r?$", re.M)
LONGEST_HEADER = 1 << 16
INDICES = ("vertex_indices", "vertex_index")
ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass
class Element:
    """One element of the header: its count, and (name, type, type of a list's length or None) of each property."""

    name: str
    count: int
    properties: list[tuple[str, str, str | None]] = field(default_factory=list)


def read_ply(path: Path) -> Decoded:
    """Vertices, faces and the vertices' other scalar properties.

    Raises
    ------
    ValueError
        If the header is not PLY's or the data end early.
    """
    data = path.read_bytes()
    order, elements, offset = _header(data)
    columns: dict[str, dict[str, Any]] = {}
    notes: tuple[str, ...] = ()
    if order == "=":
        columns = _ascii_columns(data[offset:], elements)
    else:
        for element in elements:
            columns[element.name], offset = _binary_element(data, offset, element, order)
        if rest := len(data[offset:].strip()):
            notes = (f"{rest} bytes behind the last element are passed over.",)
    vertex, polygons, strips = columns.get("vertex", {}), _lists(columns, "face"), _lists(columns, "tristrips")
    if not {"x", "y", "z"} <= set(vertex) or (polygons is None and strips is None and not len(vertex["x"])):
        raise ValueError(
            "it has no element 'vertex' with x, y, z or no element 'face' or 'tristrips' with vertex_indices"
        )
    positions = np.stack([np.asarray(vertex.pop(axis), dtype=np.float64) for axis in "xyz"], axis=1)
    scalars = {
        name: np.asarray(column, dtype=float) for name, column in vertex.items() if isinstance(column, np.ndarray)
    }
    found = triangles_of_strips([] if strips is None else strips)
    if polygons is None:  # points alone have no faces
        return Decoded(positions, found, scalars, notes)
    if beside := [name for name in columns["face"] if name not in INDICES]:
        notes += (f"Properties of faces are passed over: {', '.join(beside)}.",)
    return Decoded(positions, polygons if not len(found) else [*found.tolist(), *polygons], scalars, notes)


def _ascii_columns(data: bytes, elements: list[Element]) -> dict[str, dict[str, Any]]:
    """Columns of all elements, word by word; where a row has more than is declared, row by row."""
    words, at = data.split(), 0
    columns = {}
    try:
        for element in elements:
            columns[element.name], at = _ascii_element(words, at, element)
        if at == len(words):
            return columns
        error = ValueError(f"it has {len(words)} numbers where {at} are declared")
    except ValueError as found:
        error = found
    try:
        return _ascii_rows(data.splitlines(), elements)
    except (ValueError, IndexError):
        raise error from None


def _lists(columns: dict[str, dict[str, Any]], element: str) -> Any:
    found = columns.get(element, {})
    return next((found[name] for name in INDICES if name in found), None)


def _header(data: bytes) -> tuple[str, list[Element], int]:
    closing = re.search(rb"(?:^|[\r\n])[ \t]*end_header[ \t]*(?:\r\n|\n|\r|$)", data)
    if not data.startswith(b"ply") or closing is None:
        raise ValueError("it has no PLY header")
    end = closing.start()
    order, elements = "", list[Element]()
    for line in data[:end].decode("utf-8", "replace").splitlines():
        words = line.split()
        if words[:1] == ["format"] and len(words) > 1 and words[1] in ORDERS:
            order = ORDERS[words[1]]
        elif words[:1] == ["element"] and len(words) == 3:
            elements.append(Element(words[1], int(words[2])))
        elif words[:1] == ["property"] and elements:
            if any(word not in TYPES for word in (words[2:4] if words[1:2] == ["list"] else words[1:2])):
                raise ValueError(f"header line {line!r} has an unknown type")
            is_list = words[1] == "list"
            elements[-1].properties.append((words[-1], TYPES[words[-2]], TYPES[words[2]] if is_list else None))
    if not order:
        raise ValueError("its header names no format")
    return order, elements, closing.end()


def _ascii_element(words: list[bytes], at: int, element: Element) -> tuple[dict[str, Any], int]:
    width = len(element.properties)
    if all(length is None for _, _, length in element.properties):
        block = words[at : at + width * element.count]
        if len(block) < width * element.count:
            raise ValueError(
                f"it ends after {len(block) // max(width, 1)} of {element.count} entries of {element.name!r}"
            )
        table = np.array(block, dtype=np.float64).reshape(element.count, width)
        return {name: table[:, k] for k, (name, _, _) in enumerate(element.properties)}, at + len(block)
    lists: dict[str, list[list[float]]] = {name: [] for name, _, _ in element.properties}
    for index in range(element.count):
        for name, kind, length in element.properties:
            if length and at < len(words) and not words[at].isdigit():
                said = words[at][:20].decode("ascii", "replace")
                raise ValueError(
                    f"entry {index} of {element.name!r} has {said!r} where the length of {name!r} is needed"
                )
            size = int(words[at]) if length and at < len(words) else 1
            at += bool(length)
            if size < 0 or at + size > len(words):
                raise ValueError(f"it ends after {index} of {element.count} entries of {element.name!r}")
            lists[name].append(list(map(int if kind[0] in "iu" else float, words[at : at + size])))
            at += size
    return {name: _scalars_or_lists(lists[name], length) for name, _, length in element.properties}, at


def _ascii_rows(lines: list[bytes], elements: list[Element]) -> dict[str, dict[str, Any]]:
    """Columns of elements of which each has a row of its own; what follows the declared properties is left out."""
    rows = [words for line in lines if (words := line.split())]
    columns = {}
    at = 0
    for element in elements:
        kept: list[bytes] = []
        for number, row in enumerate(rows[at : at + element.count]):
            width = 0
            for _, _, length in element.properties:
                width += 1 + (int(row[width]) if length and width < len(row) else 0)
            if width > len(row):
                raise ValueError(f"entry {number} of {element.name!r} is cut short")
            kept += row[:width]
        columns[element.name], _ = _ascii_element(kept, 0, element)
        at += element.count
    if at < len(rows):
        raise ValueError(f"it has {len(rows)} rows where {at} are declared")
    return columns


def _scalars_or_lists(rows: list[list[float]], length: str | None) -> Any:
    return rows if length is not None else np.array(rows, dtype=np.float64).reshape(-1)


def _binary_element(data: bytes, at: int, element: Element, order: str) -> tuple[dict[str, Any], int]:
    """Columns of one element; rows whose lists all have the length of the first are read at once."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    position, lengths = at, {}
    for name, kind, length in element.properties:
        if length is None:
            fields.append((name, order + kind))
            position += np.dtype(kind).itemsize
            continue
        first = data[position : position + np.dtype(length).itemsize]
        size = int(np.frombuffer(first, order + length)[0]) if element.count and len(first) else 0
        fields += [(f"{name} length", order + length), (name, order + kind, (size,))]
        lengths[name] = size
        position += np.dtype(length).itemsize + size * np.dtype(kind).itemsize
    row = np.dtype(fields)
    if at + row.itemsize * element.count <= len(data):
        table = np.frombuffer(data, row, element.count, at)
        if all((table[f"{name} length"] == size).all() for name, size in lengths.items()):
            columns = {name: _column(table[name], name in lengths) for name, _, _ in element.properties}
            return columns, at + row.itemsize * element.count
    if not lengths:
        raise ValueError(
            f"it ends after {(len(data) - at) // row.itemsize} of {element.count} entries of {element.name!r}"
        )
    return _mixed_element(data, at, element, order)


def _column(values: NDArray[Any], is_list: bool) -> Any:
    return values.tolist() if is_list and values.shape[1] != 3 else values


def _mixed_element(data: bytes, at: int, element: Element, order: str) -> tuple[dict[str, Any], int]:
    lists: dict[str, list[list[float]]] = {name: [] for name, _, _ in element.properties}
    for index in range(element.count):
        for name, kind, length in element.properties:
            try:
                size = 1
                if length is not None:
                    size = int(np.frombuffer(data, order + length, 1, at)[0])
                    at += np.dtype(length).itemsize
                lists[name].append(np.frombuffer(data, order + kind, size, at).tolist())
            except ValueError as error:
                raise ValueError(f"it ends after {index} of {element.count} entries of {element.name!r}") from error
            at += size * np.dtype(kind).itemsize
    return {name: _scalars_or_lists(lists[name], length) for name, _, length in element.properties}, at


def hemisphere_of_ply(path: Path) -> str:
    """Return "left" or "right" where a comment of the header says so, else nothing."""
    with path.open("rb") as stream:
        head = stream.read(LONGEST_HEADER).partition(b"end_header")[0]
    found = HEMISPHERE.search(head)
    return found[1].decode() if found and head.startswith(b"ply") else ""


def write_ply(path: Path, mesh: TriangleMesh, scalars: dict[str, Floats] | None = None, hemisphere: str = "") -> None:
    """Write binary little-endian PLY in double precision, each scalar map as a vertex property of its name.

    The hemisphere is a comment of the header.

    A map of three whole numbers from 0 to 255 that is called a colour is written as such, as viewers read it; so are three maps
    red, green, blue, and alpha beside them.
    """
    colours = {name: values for name, values in (scalars or {}).items() if _is_colour(name, values)}
    if len(colours) > 1:
        raise ValueError(f"maps {', '.join(colours)} are all colours, a PLY file holds one: leave the others out")
    channels = scalar_channels({name: values for name, values in (scalars or {}).items() if name not in colours})
    reserved = ("x", "y", "z", *(COLOURS if colours else ()))
    properties = [(axis, "double", "<f8", mesh.vertices[:, k]) for k, axis in enumerate("xyz")]
    names = names_without_spaces(channels, reserved)
    whole = {name for name in (*COLOURS, ALPHA) if name in channels and are_bytes(channels[name])}
    seen = whole if set(COLOURS) <= whole else set()
    for name, values in zip(names, channels.values(), strict=True):
        properties.append((name, *(("uchar", "u1") if name in seen else ("double", "<f8")), values))
    for values in colours.values():
        properties += [(name, "uchar", "u1", values[:, k]) for k, name in enumerate(COLOURS)]
    head = ["ply", "format binary_little_endian 1.0", *([f"comment hemisphere {hemisphere}"] if hemisphere else [])]
    head.append(f"element vertex {len(mesh.vertices)}")
    head += [f"property {kind} {name}" for name, kind, _, _ in properties]
    head += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header", ""]
    vertices = np.empty(len(mesh.vertices), dtype=[(name, code) for name, _, code, _ in properties])
    for name, _, _, values in properties:
        vertices[name] = values
    faces = np.empty(len(mesh.faces), dtype=[("length", "u1"), ("corners", "<i4", (3,))])
    faces["length"], faces["corners"] = 3, mesh.faces
    path.write_bytes("\n".join(head).encode("utf-8") + vertices.tobytes() + faces.tobytes())


def _is_colour(name: str, values: Floats) -> bool:
    """Whether a map is a colour: by its name, its three channels, and their range."""
    named = any(word in name.lower() for word in ("rgb", "color", "colour"))
    return named and values.ndim == 2 and values.shape[1] == 3 and are_bytes(values)
