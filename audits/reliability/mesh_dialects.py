"""OFF, PLY, STL, OBJ and TOSCA's pairs as programs write them, by hand."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from audits.reliability.scene import Scene
from audits.reliability.truth import SURFACE, Truth

Written = tuple[Path, Truth]


def _rows(values: np.ndarray, pattern: str = "") -> list[str]:
    return [" ".join(format(x, pattern) if pattern else repr(x) for x in row) for row in values.tolist()]


def _ends(text: str, rng: np.random.Generator) -> bytes:
    """Lines end as on Unix, Windows, or without the last one."""
    way = int(rng.integers(3))
    return (text.replace("\n", "\r\n") if way == 1 else text.rstrip("\n") if way == 2 else text).encode()


def off(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """Every header, comments, colours and normals in rows, colours of faces, counts behind OFF."""
    n, m, v = len(scene.vertices), len(scene.polygons), scene.vertices
    head = str(rng.choice(["OFF", "COFF", "NOFF", "CNOFF", "STOFF", "4OFF", "nOFF 3", "glued", "beside", ""]))
    more = {"C": [" 0.5 0.25 1 1"] * n, "N": [" 0 0 1"] * n, "ST": [" 0.5 0.5"] * n}
    rows = _rows(v)
    if head == "4OFF":
        scale = 2.0 ** rng.integers(-2, 3, n)
        rows = _rows(np.column_stack([v * scale[:, None], scale]))
    behind = {"COFF": "C", "NOFF": "N", "STOFF": "ST"}.get(head)
    if behind:
        rows = [a + b for a, b in zip(rows, more[behind], strict=True)]
    if head == "CNOFF":
        rows = [a + " 0 0 1 0.5 0.25 1 1" for a in rows]
    paint = str(rng.choice(["", " 255 0 0", " 0.1 0.2 0.3 1.0", " 3"]))
    faces = [f"{len(p)} {' '.join(map(str, p))}{paint}" for p in scene.polygons]
    counts = f"{n} {m}" + str(rng.choice([" 0", f" {n + m}"]))
    first = {"glued": f"OFF{counts}", "beside": f"OFF {counts}", "": counts}.get(head, f"{head}\n{counts}")
    lines = [first, *rows, *faces]
    if rng.random() < 0.5 and head not in ("", "glued"):
        lines.insert(1, "# written by hand")
        lines[3:3] = ["", "   "]
    path = folder / "a.off"
    path.write_bytes(_ends("\n".join(lines) + "\n", rng))
    return path, Truth(SURFACE, v, scene.polygons)


PLY = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
}
WORDS = {"char": "int8", "uchar": "uint8", "short": "int16", "int": "int32", "uint": "uint32", "float": "float32"}


def ply(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """ASCII and both byte orders; odd properties and elements, types in both spellings, comments, faces before vertices."""
    order = str(rng.choice(["ascii", "binary_little_endian", "binary_big_endian"]))
    n, kind = len(scene.vertices), str(rng.choice(["float", "double"]))
    columns: list[tuple[str, str, np.ndarray]] = [(a, kind, scene.vertices[:, k]) for k, a in enumerate("xyz")]
    if rng.random() < 0.5:
        columns += [(name, "uchar", rng.integers(0, 256, n)) for name in ("red", "green", "blue", "alpha")]
    if rng.random() < 0.5:
        columns += [(name, "float", rng.standard_normal(n)) for name in ("nx", "ny", "nz")]
    columns += [("quality", "double", scene.maps["gaps"]), ("label", "short", scene.labels)]
    if rng.random() < 0.5:
        columns = [columns[k] for k in rng.permutation(len(columns))]
    vertex = [f"element vertex {n}", *(f"property {_word(kind, rng)} {name}" for name, kind, _ in columns)]
    count, corner = str(rng.choice(["uchar", "int", "ushort"])), str(rng.choice(["int", "uint", "short"]))
    list_name = str(rng.choice(["vertex_indices", "vertex_index"]))
    before, behind = bool(rng.integers(2)), bool(rng.integers(2))
    face = [f"element face {len(scene.polygons)}"]
    face += [f"property {_word('uchar', rng)} flags"] * before
    face += [f"property list {_word(count, rng)} {_word(corner, rng)} {list_name}"]
    face += ["property list uchar float texcoord"] * behind
    rows = [[(kind, values[k]) for _, kind, values in columns] for k in range(n)]
    corners = [
        [("uchar", 7)] * before
        + [(count, len(p)), *((corner, k) for k in p)]
        + ([("uchar", 2), ("float", 0.5), ("float", 0.25)] if behind else [])
        for p in scene.polygons
    ]
    elements = [(vertex, rows), (face, corners)]
    if rng.random() < 0.3:
        elements.append(
            (["element edge 2", "property int vertex1", "property int vertex2"], [[("int", 0), ("int", 1)]] * 2)
        )
    if rng.random() < 0.3:
        elements.insert(0, (["element camera 1", "property float view", "property list uchar int odd"], [
            [("float", 0.5), ("uchar", 3), ("int", 1), ("int", 2), ("int", 3)]]))  # fmt: skip
    if rng.random() < 0.2:
        elements.reverse()
    head = ["ply", f"format {order} 1.0", "comment end_header is not here", "obj_info num_cols 512"]
    head += [line for lines, _ in elements for line in lines] + ["end_header"]
    body = b"".join(_ply_row(row, order) for _, rows in elements for row in rows)
    path = folder / "a.ply"
    path.write_bytes("\n".join(head).encode() + b"\n" + body)
    text = order == "ascii"
    maps = {name: _told(values, kind, text) for name, kind, values in columns if name not in "xyz"}
    vertices = np.stack([_told(scene.vertices[:, k], kind, text) for k in range(3)], axis=1)
    return path, Truth(SURFACE, vertices, scene.polygons, maps)


def _told(values: np.ndarray, kind: str, text: bool) -> np.ndarray:
    """Return the numbers as they stand in the file: nine digits of single precision in text."""
    rounded = values.astype(PLY[kind]).astype(float)
    return np.array([float(f"{x:.9g}") for x in rounded.tolist()]) if text and kind == "float" else rounded


def _word(kind: str, rng: np.random.Generator) -> str:
    return WORDS.get(kind, kind) if rng.random() < 0.3 else kind


def _ply_row(row: list[tuple[str, float]], order: str) -> bytes:
    if order == "ascii":
        return (" ".join(_digits(kind, x) for kind, x in row) + "\n").encode()
    sign = "<" if "little" in order else ">"
    return b"".join(np.array(x).astype(sign + PLY[kind]).tobytes() for kind, x in row)


def _digits(kind: str, x: float) -> str:
    return f"{np.float32(x):.9g}" if kind == "float" else repr(float(x)) if kind == "double" else str(int(x))


def stl(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """Text, in capitals, of several solids, with any name; bytes whose head says solid, with colours behind triangles."""
    triangles = [p for p in scene.polygons if len(p) == 3] or [scene.polygons[0][:3]]
    vertices, path = scene.single, folder / "a.stl"
    if rng.random() < 0.5:
        head = str(rng.choice(["", "solid made by a program", "COLOR=\x10\x20\x30\x40"])).encode().ljust(80)
        body = b"".join(
            struct.pack("<12fH", 0.0, 0.0, 1.0, *vertices[p].ravel(), int(rng.integers(0, 65536))) for p in triangles
        )
        path.write_bytes(head + struct.pack("<I", len(triangles)) + body)
        return path, Truth(SURFACE, vertices, triangles, welded=True)
    name = str(rng.choice(["", "part", "a vertex 1 2 3", "facet normal", "endsolid"]))
    parts = [triangles] if len(triangles) < 2 or rng.random() < 0.7 else [triangles[:1], triangles[1:]]
    pattern = str(rng.choice([".9g", ".9e", "+.8e"]))
    text = ""
    for part in parts:
        facets = [
            "  facet normal 0 0 1\n    outer loop\n"
            + "".join(f"      vertex {row}\n" for row in _rows(vertices[p], pattern))
            + "    endloop\n  endfacet\n"
            for p in part
        ]
        text += f"solid {name}\n" + "".join(facets) + f"endsolid {name}\n"
    path.write_bytes(_ends(text.upper() if rng.random() < 0.3 else text, rng))
    told = np.array([[float(format(x, pattern)) for x in row] for row in vertices.tolist()])
    return path, Truth(SURFACE, told, triangles, welded=True)


def obj(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """Polygons, negative numbers, texture and normals, colours, weights, byte order mark, broken lines, groups."""
    n, v = len(scene.vertices), scene.vertices
    more = str(rng.choice(["", " 1.0", " 0.5 0.25 1.0"]))
    lines = ["# a comment", "mtllib a.mtl", "o thing", *(f"v {row}{more}" for row in _rows(v))]
    corner = str(rng.choice(["{0}", "{0}/{0}", "{0}//{0}", "{0}/{0}/{0}", "{0}/"]))
    if "/" in corner:
        lines += ["vt 0.5 0.5"] * n + ["vn 0 0 1"] * n
    lines += ["g part", "usemtl white", "s off", "l 1 2"]
    negative, broken, behind = bool(rng.integers(2)), rng.random() < 0.3, str(rng.choice(["", "", " ", " # end"]))
    for polygon in scene.polygons:
        words = [corner.format(k - n if negative else k + 1) for k in polygon]
        between = " \\\n " if broken else "  "
        lines.append("f " + words[0] + between + " ".join(words[1:]) + behind)
    text = "\n".join(lines) + "\n"
    mark = b"\xef\xbb\xbf" if rng.random() < 0.3 else b""
    path = folder / "a.obj"
    path.write_bytes(mark + _ends(text, rng))
    shares = dict(zip(("red", "green", "blue"), map(float, more.split()), strict=False)) if len(more) > 4 else {}
    maps = {name: np.full(n, 255.0 * share) for name, share in shares.items()}
    return path, Truth(SURFACE, v, scene.polygons, maps)


def obj_interleaved(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """Vertices between faces, which count back from where they stand."""
    lines: list[str] = []
    vertices: list[np.ndarray] = []
    polygons = []
    for polygon in scene.polygons:
        lines += [f"v {row}" for row in _rows(scene.vertices[polygon])]
        vertices.append(scene.vertices[polygon])
        size, count = len(polygon), sum(map(len, vertices))
        polygons.append(list(range(count - size, count)))
        lines.append("f " + " ".join(str(k - size) for k in range(size)))
    path = folder / "a.obj"
    path.write_bytes(_ends("\n".join(lines) + "\n", rng))
    return path, Truth(SURFACE, np.concatenate(vertices), polygons)


def mni_obj(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """CIVET's .obj in text, one colour, one for each polygon or for each vertex."""
    n, m = len(scene.vertices), len(scene.polygons)
    way = int(rng.integers(3))
    colours = " ".join(["1 1 1 1"] * (1, m, n)[way])
    ends = np.cumsum([len(p) for p in scene.polygons]).tolist()
    corners = [k for p in scene.polygons for k in p]
    chunk = ["\n".join(" ".join(map(str, row[k : k + 8])) for k in range(0, len(row), 8)) for row in (ends, corners)]
    text = [
        f"P 0.3 0.3 0.4 10 1 {n}",
        *_rows(scene.vertices),
        "",
        *["0 0 1"] * n,
        "",
        str(m),
        f"{way} {colours}",
        "",
        *chunk,
    ]
    path = folder / "a.obj"
    path.write_text("\n".join(text) + "\n")
    return path, Truth(SURFACE, scene.vertices, scene.polygons)


def tosca(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.vert and .tri, counted from 1."""
    triangles = [p[:3] for p in scene.polygons]
    (folder / "a.vert").write_text("\n".join(_rows(scene.vertices)) + "\n")
    (folder / "a.tri").write_text("\n".join(" ".join(str(k + 1) for k in t) for t in triangles) + "\n")
    return folder / "a.tri", Truth(SURFACE, scene.vertices, triangles)


DIALECTS = (off, ply, stl, obj, obj_interleaved, mni_obj, tosca)
