"""Legacy VTK and VTK's XML as old and new versions and other programs write them, by hand."""

from __future__ import annotations

import base64
import zlib
from pathlib import Path

import numpy as np

from audits.reliability.scene import Scene
from audits.reliability.truth import SURFACE, Truth
from surfexp.contract.arrays import Floats

Written = tuple[Path, Truth]
KINDS = {"float": "f4", "double": "f8", "int": "i4", "vtkIdType": "i4", "vtktypeint64": "i8", "unsigned_char": "u1"}


class _Legacy:
    """Pieces of a legacy file, in text or bytes."""

    def __init__(self, binary: bool, rng: np.random.Generator, version: str = "3.0") -> None:
        self.binary, self.rng = binary, rng
        self.data = f"# vtk DataFile Version {version}\na title\n{'BINARY' if binary else 'ASCII'}\n".encode()

    def say(self, line: str) -> None:
        self.data += f"{line}\n".encode()

    def numbers(self, values: np.ndarray, kind: str) -> None:
        flat = np.asarray(values).ravel().astype(KINDS[kind])
        if self.binary:
            self.data += flat.astype(flat.dtype.newbyteorder(">")).tobytes() + b"\n"
            return
        words = [repr(x) if kind == "double" else f"{x:.9g}" if kind == "float" else str(x) for x in flat.tolist()]
        width = int(self.rng.integers(1, 12))  # rows of any length: the format goes by numbers
        self.data += "".join(" ".join(words[k : k + width]) + " \n" for k in range(0, len(words), width)).encode()

    def points(self, scene: Scene, kind: str) -> Floats:
        self.say(f"POINTS {len(scene.vertices)} {kind}")
        self.numbers(scene.vertices, kind)
        return scene.vertices.astype(KINDS[kind]).astype(float)

    def cells(self, keyword: str, polygons: list[list[int]]) -> None:
        flat = [number for polygon in polygons for number in (len(polygon), *polygon)]
        self.say(f"{keyword} {len(polygons)} {len(flat)}")
        self.numbers(np.array(flat), "int")


def legacy_polydata(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """POLYDATA with attributes of points, among data of cells."""
    file = _Legacy(bool(rng.integers(2)), rng, str(rng.choice(["2.0", "3.0", "4.2"])))
    file.say("DATASET POLYDATA")
    kind = str(rng.choice(["float", "double"]))
    vertices = file.points(scene, kind)
    file.cells("POLYGONS", scene.polygons)
    maps = _attributes(file, scene, rng)
    return _saved(folder, file, Truth(SURFACE, vertices, scene.polygons, maps))


def _attributes(file: _Legacy, scene: Scene, rng: np.random.Generator) -> dict[str, Floats]:
    n, m = len(scene.vertices), len(scene.polygons)
    maps: dict[str, Floats] = {}
    if rng.random() < 0.5:
        file.say(f"CELL_DATA {m}")
        file.say("SCALARS region int 1")
        file.say("LOOKUP_TABLE default")
        file.numbers(np.arange(m), "int")
        if rng.random() < 0.5:
            file.say("NORMALS cell_normals float")
            file.numbers(rng.standard_normal((m, 3)), "float")
    file.say(f"POINT_DATA {n}")
    parts = ["scalars", "normals", "field", "colours", "texture", "vectors", "table"]
    for part in rng.permutation(parts)[: int(rng.integers(1, len(parts) + 1))].tolist():
        if part == "scalars":
            kind = str(rng.choice(["float", "double"]))
            file.say(f"SCALARS depth {kind}" + str(rng.choice(["", " 1"])))
            if rng.random() < 0.8:
                file.say("LOOKUP_TABLE default")
            file.numbers(scene.maps["depth"], kind)
            maps["depth"] = scene.maps["depth"].astype(KINDS[kind]).astype(float)
        elif part == "vectors":
            file.say("VECTORS flow double")
            file.numbers(scene.maps["flow"], "double")
            maps["flow"] = scene.maps["flow"]
        elif part == "normals":
            file.say("NORMALS normals float")
            file.numbers(rng.standard_normal((n, 3)), "float")
        elif part == "texture":
            file.say("TEXTURE_COORDINATES uv 2 float")
            file.numbers(rng.random((n, 2)), "float")
        elif part == "colours":
            file.say("COLOR_SCALARS rgb 3")
            file.numbers(rng.integers(0, 256, (n, 3)), "unsigned_char" if file.binary else "float")
        elif part == "table":
            file.say("LOOKUP_TABLE colours 4")
            file.numbers(rng.integers(0, 2, 16), "unsigned_char" if file.binary else "float")
        else:
            file.say("FIELD FieldData 2")
            file.say(f"gaps 1 {n} double")
            file.numbers(scene.maps["gaps"], "double")
            file.say(f"labels 1 {n} int")
            file.numbers(scene.labels, "int")
            maps |= {"gaps": scene.maps["gaps"], "labels": scene.labels.astype(float)}
    return maps


def legacy_strips(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """POLYDATA of triangle strips beside polygons, vertices and lines."""
    file = _Legacy(bool(rng.integers(2)), rng)
    file.say("DATASET POLYDATA")
    vertices = file.points(scene, "double")
    n = len(vertices)
    strips = [
        rng.permutation(n)[: int(rng.integers(3, min(n, 9) + 1))].tolist() for _ in range(int(rng.integers(1, 6)))
    ]
    if rng.random() < 0.5:
        file.cells("VERTICES", [[0], [1, 2]])
    if rng.random() < 0.5:
        file.cells("LINES", [[0, 1, 2]])
    beside = scene.polygons if rng.random() < 0.5 else []
    if beside:
        file.cells("POLYGONS", beside)
    file.cells("TRIANGLE_STRIPS", strips)
    return _saved(folder, file, Truth(SURFACE, vertices, [*beside, *_triangles_of(strips)]))


def _triangles_of(strips: list[list[int]]) -> list[list[int]]:
    return [
        [s[k], s[k + 1], s[k + 2]] if k % 2 == 0 else [s[k + 1], s[k], s[k + 2]]
        for s in strips
        for k in range(len(s) - 2)
    ]


def legacy_unstructured(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """UNSTRUCTURED_GRID of triangles, polygons, pixels and lines; one with a volume has to be refused."""
    file = _Legacy(bool(rng.integers(2)), rng)
    file.say("DATASET UNSTRUCTURED_GRID")
    vertices = file.points(scene, "double")
    cells, kinds, told = [], [], []
    for polygon in scene.polygons:
        kind = {3: 5, 4: int(rng.choice([9, 8, 7]))}.get(len(polygon), 7)
        cells.append([polygon[0], polygon[1], polygon[3], polygon[2]] if kind == 8 else polygon)
        kinds.append(kind)
        told.append(polygon)
        if rng.random() < 0.1:
            cells.append(polygon[:2])
            kinds.append(3)
    volume = rng.random() < 0.1
    if volume:
        cells.append([0, 1, 2, 3])
        kinds.append(10)
    file.cells("CELLS", cells)
    file.say(f"CELL_TYPES {len(kinds)}")
    file.numbers(np.array(kinds), "int")
    file.say(f"POINT_DATA {len(vertices)}")
    file.say("SCALARS depth double 1")
    file.say("LOOKUP_TABLE default")
    file.numbers(scene.maps["depth"], "double")
    truth = Truth(
        SURFACE, vertices, told, {"depth": scene.maps["depth"]}, refused="extract the surface" if volume else ""
    )
    return _saved(folder, file, truth)


def legacy_version_5(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """Version 5.1: OFFSETS and CONNECTIVITY, metadata of arrays, names with spaces as %20."""
    file = _Legacy(bool(rng.integers(2)), rng, "5.1")
    file.say("DATASET POLYDATA")
    vertices = file.points(scene, "double")
    starts = np.concatenate([[0], np.cumsum([len(p) for p in scene.polygons])])
    file.say(f"POLYGONS {len(starts)} {starts[-1]}")
    file.data += b"OFFSETS vtktypeint64\n"
    file.numbers(starts, "vtktypeint64")
    file.say("CONNECTIVITY vtktypeint64")
    file.numbers(np.concatenate(scene.polygons), "vtktypeint64")
    file.say(f"POINT_DATA {len(vertices)}")
    file.say("FIELD FieldData 1")
    file.say(f"sulcal%20depth 1 {len(vertices)} double")
    file.numbers(scene.maps["depth"], "double")
    file.say("METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n")
    return _saved(folder, file, Truth(SURFACE, vertices, scene.polygons, {"sulcal depth": scene.maps["depth"]}))


def _saved(folder: Path, file: _Legacy, truth: Truth) -> Written:
    path = folder / "a.vtk"
    path.write_bytes(file.data)
    return path, truth


def xml_polydata(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.vtp in text, base64 or appended bytes, whole or in packed blocks, either byte order, 32 or 64 bit counts."""
    writer = _Xml(rng)
    verts, polys = scene.vertices, scene.polygons
    ends = np.cumsum([len(p) for p in polys])
    maps = {"depth": scene.maps["depth"], "flow & so": scene.maps["flow"]}
    body = "".join(writer.array(name.replace("&", "&amp;"), values) for name, values in maps.items())
    text = (
        f'<PolyData><Piece NumberOfPoints="{len(verts)}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" '
        f'NumberOfPolys="{len(polys)}"><PointData Scalars="depth">{body}</PointData><CellData>'
        f"{writer.array('region', np.arange(len(polys)))}</CellData>"
        f"<Points>{writer.array('Points', verts)}</Points><Polys>{writer.array('connectivity', np.concatenate(polys))}"
        f"{writer.array('offsets', ends)}</Polys></Piece></PolyData>"
    )
    path = folder / "a.vtp"
    path.write_bytes(writer.whole("PolyData", text))
    return path, Truth(SURFACE, verts, polys, maps)


def xml_unstructured(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.vtu of triangles and quadrangles."""
    writer = _Xml(rng)
    verts, polys = scene.vertices, scene.polygons
    kinds = np.array([5 if len(p) == 3 else 9 if len(p) == 4 else 7 for p in polys])
    text = (
        f'<UnstructuredGrid>\n<Piece NumberOfPoints="{len(verts)}" NumberOfCells="{len(polys)}">\n<Points>'
        f"{writer.array('Points', verts)}</Points><Cells>{writer.array('connectivity', np.concatenate(polys))}"
        f"{writer.array('offsets', np.cumsum([len(p) for p in polys]))}{writer.array('types', kinds.astype(np.uint8))}</Cells>"
        f"<PointData>{writer.array('gaps', scene.maps['gaps'])}</PointData></Piece></UnstructuredGrid>"
    )
    path = folder / "a.vtu"
    path.write_bytes(writer.whole("UnstructuredGrid", text))
    return path, Truth(SURFACE, verts, polys, {"gaps": scene.maps["gaps"]})


class _Xml:
    """Arrays of VTK's XML files in one of their ways."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.way = str(rng.choice(["ascii", "binary", "raw", "base64"]))
        self.packed = self.way != "ascii" and bool(rng.integers(2))
        self.wide, self.big = bool(rng.integers(2)), bool(rng.integers(2))
        self.block = int(rng.choice([64, 1024, 32768]))
        self.appended = b""

    def whole(self, kind: str, text: str) -> bytes:
        packing = ' compressor="vtkZLibDataCompressor"' if self.packed else ""
        head = (
            f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="{"Big" if self.big else "Little"}Endian"'
            f' header_type="UInt{64 if self.wide else 32}"{packing}>\n'
        )
        tail = b""
        if self.way in ("raw", "base64"):
            tail = f'<AppendedData encoding="{self.way}">\n _'.encode() + self.appended + b"\n</AppendedData>"
        return head.encode() + text.encode() + tail + b"\n</VTKFile>\n"

    def array(self, name: str, values: np.ndarray) -> str:
        kinds = {"f": ("Float64", "f8"), "i": ("Int64", "i8"), "u": ("UInt8", "u1")}
        kind, code = kinds[values.dtype.kind]
        width = values.shape[1] if values.ndim == 2 else 1
        tag = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}"'
        if self.way == "ascii":
            words = " ".join(repr(x) for x in values.ravel().tolist())
            return f'{tag} format="ascii">\n{words}\n</DataArray>'
        content = self._coded(values.astype((">" if self.big else "<") + code).tobytes())
        if self.way == "binary":
            return f'{tag} format="binary">\n {content.decode()}\n</DataArray>'
        offset, self.appended = len(self.appended), self.appended + content
        return f'{tag} format="appended" offset="{offset}"/>'

    def _coded(self, data: bytes) -> bytes:
        code = base64.b64encode if self.way != "raw" else bytes
        if not self.packed:
            return code(self._count(len(data)) + data)
        blocks = [data[k : k + self.block] for k in range(0, len(data), self.block)]
        packed = [zlib.compress(block) for block in blocks]
        last = len(blocks[-1]) % self.block if blocks else 0
        head = b"".join(map(self._count, [len(blocks), self.block, last, *map(len, packed)]))
        return code(head) + code(b"".join(packed))

    def _count(self, number: int) -> bytes:
        return number.to_bytes(8 if self.wide else 4, "big" if self.big else "little")


DIALECTS = (legacy_polydata, legacy_strips, legacy_unstructured, legacy_version_5, xml_polydata, xml_unstructured)
