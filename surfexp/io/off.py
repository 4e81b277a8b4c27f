"""OFF files in text: OFF, COFF, NOFF, STOFF, 4OFF and their mixtures, with or without the header."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from surfexp.io.mesh_file import Decoded
from surfexp.mesh.triangle_mesh import TriangleMesh

HEADER = re.compile(r"(?P<attributes>(?:ST)?C?N?)(?P<homogeneous>4?)(?P<dimension>n?)(?:OFF|off)(?P<count>\d*)")
Rows = list[list[str]]


def read_off(path: Path) -> Decoded:
    """Vertices and faces of an OFF file in text; normals, colours and texture coordinates are left out.

    One row is read for each vertex and face; where rows do not fit, numbers are read in their order, as the format has it.
    Homogeneous coordinates (4OFF) are divided by their last. Geomview's `appearance { ... }` before the header is left out.

    Raises
    ------
    ValueError
        If the file breaks the format, is binary, of another dimension than 3, ends early, or a homogeneous coordinate is not
        positive.
    """
    bare = "\n".join(line.split("#")[0] for line in path.read_text("ascii", "replace").splitlines())
    lines = [line for raw in _behind_appearance(bare).splitlines() if (line := raw.split())]
    header = HEADER.fullmatch(lines[0][0]) if lines else None
    if header is not None:
        lines[0] = ([header["count"]] if header["count"] else []) + lines[0][1:]
        if lines[0][:1] and lines[0][0].upper() == "BINARY":
            raise ValueError("it is a binary OFF file: write it in text, or as PLY")
    elif not lines or len(lines[0]) != 3 or not all(word.isdecimal() for word in lines[0]):
        raise ValueError("the first word is not OFF")
    lines = [line for line in lines if line]
    if header is not None and header["dimension"] and (lines.pop(0) if lines else []) != ["3"]:
        raise ValueError("its header is nOFF of a dimension that is not 3: three coordinates a vertex are needed")
    if not lines or len(lines[0]) < 2:
        raise ValueError("the counts of vertices and faces are missing")
    vertex_count, face_count = int(lines[0][0]), int(lines[0][1])
    width = 4 if header is not None and header["homogeneous"] else 3
    # the count of edges is left out by some
    body = [line for line in [lines[0][3:], *lines[1:]] if line]
    try:
        rows, polygons = _by_rows(body, vertex_count, face_count, width)
    except ValueError as error:
        if header is not None and header["attributes"]:
            raise
        try:
            rows, polygons = _by_words(body, vertex_count, face_count, width)
        except ValueError:
            raise error from None
    vertices = np.array(rows, dtype=np.float64).reshape(vertex_count, width)
    if width == 4:
        least, most = vertices[:, 3].min(initial=1.0), vertices[:, 3].max(initial=1.0)
        if not least > 0:
            raise ValueError(
                f"its homogeneous coordinates (4OFF) end in numbers from {least:g} to {most:g}, positive ones are needed: "
                "a surface in four dimensions has to be projected first"
            )
        vertices = vertices[:, :3] / vertices[:, 3:]
    return Decoded(vertices, polygons)


def _behind_appearance(text: str) -> str:
    """Return what follows Geomview's description of the appearance, or all where there is none."""
    begin = re.match(r"\s*appearance\s*\{", text)
    depth, at = (1, begin.end()) if begin else (0, 0)
    while depth and at < len(text):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        at += 1
    return text[at:]


def _by_rows(body: Rows, vertex_count: int, face_count: int, width: int) -> tuple[Rows, list[list[int]]]:
    if len(body) < vertex_count + face_count:
        raise ValueError(f"it ends after {len(body)} of {vertex_count} vertices and {face_count} faces")
    rows = [line[:width] for line in body[:vertex_count]]
    for number, row in enumerate(rows):
        if len(row) < width:
            raise ValueError(f"vertex {number} has {len(row)} coordinates, {width} are needed")
    if further := len(body) - vertex_count - face_count:
        raise ValueError(
            f"it announces {vertex_count} vertices and {face_count} faces and has {further} rows more: its counts are wrong, "
            "write it again"
        )
    faces = body[vertex_count:]
    polygons = [list(map(int, row[1 : 1 + int(row[0])])) for row in faces]
    for row, polygon in zip(faces, polygons, strict=True):
        if len(polygon) != int(row[0]):
            raise ValueError(f"face {faces.index(row)} is cut short: {' '.join(row)!r}")
    return rows, polygons


def _by_words(body: Rows, vertex_count: int, face_count: int, width: int) -> tuple[Rows, list[list[int]]]:
    words = [word for line in body for word in line]
    at = width * vertex_count
    # before any room is made for what a header announces
    if at + face_count > len(words):
        raise ValueError("it ends early")
    rows = [words[k : k + width] for k in range(0, at, width)]
    polygons = []
    for _ in range(face_count):
        size = int(words[at]) if at < len(words) else -1
        polygon = list(map(int, words[at + 1 : at + 1 + size]))
        if size < 0 or len(polygon) != size:
            raise ValueError("it ends early")
        polygons.append(polygon)
        at += 1 + size
    if at != len(words):
        raise ValueError(f"it has {len(words)} numbers, {at} are announced")
    return rows, polygons


def write_off(path: Path, mesh: TriangleMesh) -> None:
    """Write vertices with all their digits, and faces."""
    vertices = "\n".join(" ".join(map(repr, row)) for row in mesh.vertices.tolist())
    faces = "\n".join(f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist())
    path.write_text(f"OFF\n{len(mesh.vertices)} {len(mesh.faces)} 0\n{vertices}\n{faces}\n")
