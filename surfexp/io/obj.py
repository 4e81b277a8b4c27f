"""Wavefront OBJ files, and the polygons of MNI's .obj files."""

from __future__ import annotations

from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from pathlib import Path

import numpy as np

from surfexp.io.mesh_file import Decoded
from surfexp.io.polygons import polygons_between
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_colours import COLOURS, as_bytes

# fmt: off
KNOWN = {
    "vt", "vn", "vp", "g", "o", "s", "mg", "usemtl", "mtllib", "l", "p", "usemap", "maplib", "cstype", "deg", "curv", "surf",
    "end", "lod", "bevel", "c_interp", "d_interp",
}
# fmt: on


def read_obj(path: Path) -> Decoded:
    """Vertices and faces of an OBJ file, and the colours behind its vertices; texture, normals, materials, groups, lines are left
    out.

    Colours ("v x y z r g b", as MeshLab and Blender write them) are maps red, green and blue from 0 to 255.

    A file of the Montreal Neurological Institute (CIVET's surfaces), which has the same suffix, begins with P.

    Raises
    ------
    ValueError
        If a vertex or face is cut short, or no vertex is there.
    """
    with path.open("rb") as stream:
        wide = stream.read(2) in (BOM_UTF16_BE, BOM_UTF16_LE)
    text = path.read_text("utf-16" if wide else "utf-8-sig", "replace")
    if text.lstrip()[:2] in ("P ", "P\t"):
        return _read_mni(text.split())
    vertices: list[list[float]] = []
    colours: list[list[float]] = []
    polygons: list[list[int]] = []
    unknown: dict[str, int] = {}
    for number, line in enumerate(text.replace("\\\n", " ").splitlines(), 1):
        words = line.split("#")[0].split()
        if not words or words[0] in KNOWN:
            continue
        try:
            if words[0] == "v" and len(words) >= 4:
                vertices.append([float(word) for word in words[1:4]])
                if len(words) >= 7:
                    colours.append([float(word) for word in words[4:7]])
                continue
            if words[0] in ("f", "fo") and len(words) >= 4:
                corners = [int(word.split("/")[0]) for word in words[1:]]
                if 0 in corners:
                    raise ValueError("corners are counted from 1")
                polygons.append([corner - 1 if corner > 0 else len(vertices) + corner for corner in corners])
                continue
        except ValueError:
            pass
        if words[0] in ("v", "f", "fo"):
            raise ValueError(f"line {number} is not an OBJ statement or is cut short: {line[:40]!r}")
        unknown[words[0][:12]] = unknown.get(words[0][:12], 0) + 1
    if not vertices:
        raise ValueError(f"it has 0 vertices and {len(polygons)} faces, at least one of each is needed")
    maps = {}
    if len(colours) == len(vertices):
        maps = dict(zip(COLOURS, as_bytes(np.array(colours)).T, strict=True))
    named = ", ".join(ascii(word) for word in list(unknown)[:5])
    notes = (f"{sum(unknown.values())} statements of unknown kinds are passed over: {named}.",) if unknown else ()
    if 0 < len(colours) < len(vertices):
        notes = (*notes, f"{len(colours)} of {len(vertices)} vertices have a colour: colours are left out.")
    return Decoded(np.array(vertices), polygons, maps, notes)


def _read_mni(words: list[str]) -> Decoded:
    """Five numbers of the material; points, their normals, polygons by where each ends; colours are left out."""
    try:
        count = int(words[6])
        points = np.array(words[7 : 7 + 3 * count], dtype=np.float64).reshape(count, 3)
        at = 7 + 6 * count
        items, colours = int(words[at]), {0: 1, 1: int(words[at]), 2: count}[int(words[at + 1])]
        at += 2 + 4 * colours
        ends = list(map(int, words[at : at + items]))
        corners = list(map(int, words[at + items : at + items + ends[-1]]))
    except (IndexError, KeyError, ValueError) as error:
        raise ValueError("it begins as an MNI .obj of polygons (P) and is cut short") from error
    return Decoded(points, polygons_between([0, *ends], corners))


def write_obj(path: Path, mesh: TriangleMesh) -> None:
    """Write vertices with all their digits, and faces."""
    lines = ["v " + " ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
