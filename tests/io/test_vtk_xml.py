"""VTK's XML files in all ways in which they are written; those that lie are refused in one line."""

from __future__ import annotations

import lzma
import zlib
from base64 import b64encode
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.io import counted_bytes
from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.mesh.shapes.icosphere import icosphere

MESH = icosphere(1).mesh
N, M = len(MESH.vertices), len(MESH.faces)
VALUES = np.random.default_rng(0).standard_normal((N, 3))
ARRAYS = {
    "depth": VALUES[:, 0].astype("f4"),
    "vector": VALUES,
    "label": np.arange(N, dtype="u2"),
    "Points": MESH.vertices,
    "connectivity": MESH.faces.ravel(),
    "offsets": 3 * np.arange(1, M + 1),
}
KINDS = {"f4": "Float32", "f8": "Float64", "u2": "UInt16", "i8": "Int64"}
PACK = {"": bytes, "vtkZLibDataCompressor": zlib.compress, "vtkLZMADataCompressor": lzma.compress}
MODES = ("inline", "base64", "raw")
BLOCK = 100


def file_of(
    mode: str = "inline", compressor: str = "", count: str = "<u4", block: int = BLOCK, name: str = "depth"
) -> bytes:
    """The file that VTK writes of ARRAYS, each array in blocks of some bytes where it is packed."""
    appended, elements = b"", {}
    for array, values in ARRAYS.items():
        kind = f"{values.dtype.kind}{values.dtype.itemsize}"
        raw = values.astype(count[0] + kind).tobytes()
        if compressor:
            blocks = [raw[k : k + block] for k in range(0, len(raw), block)]
            packed = [PACK[compressor](piece) for piece in blocks]
            head = [len(packed), block, len(raw) % block, *map(len, packed)]
            pieces = [np.array(head, count).tobytes(), b"".join(packed)]
        else:
            pieces = [np.array([len(raw)], count).tobytes() + raw]
        data = b"".join(piece if mode == "raw" else b64encode(piece) for piece in pieces)
        where = 'format="binary"' if mode == "inline" else f'format="appended" offset="{len(appended)}"'
        width = values.shape[1] if values.ndim == 2 else 1
        tag = f'DataArray type="{KINDS[kind]}" Name="{name if array == "depth" else array}" '
        tag += f'NumberOfComponents="{width}" {where}'
        elements[array] = f"<{tag}>{data.decode()}</DataArray>" if mode == "inline" else f"<{tag}/>"
        appended += data
    maps, points = "".join(list(elements.values())[:3]), elements["Points"]
    head = f'byte_order="{"LittleEndian" if count[0] == "<" else "BigEndian"}" header_type="UInt{8 * int(count[-1])}"'
    packing = f' compressor="{compressor}"' if compressor else ""
    text = (
        f'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" {head}{packing}>\n<PolyData>'
        f'<Piece NumberOfPoints="{N}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{M}">'
        f"<PointData>{maps}</PointData><CellData/><Points>{points}</Points><Verts></Verts>"
        f"<Polys>{elements['connectivity']}{elements['offsets']}</Polys></Piece></PolyData>"
    ).encode()
    if mode != "inline":
        text += f'<AppendedData encoding="{mode}">\n _'.encode() + appended + b"\n</AppendedData>"
    return text + b"</VTKFile>\n"


@pytest.mark.parametrize("count", ["<u4", "<u8", ">u4", ">u8"])
@pytest.mark.parametrize("compressor", PACK)
@pytest.mark.parametrize("mode", MODES)
def test_arrays_come_back_however_they_are_written(tmp_path: Path, mode: str, compressor: str, count: str) -> None:
    (tmp_path / "a.vtp").write_bytes(file_of(mode, compressor, count))
    vertices, faces, maps = read_mesh(tmp_path / "a.vtp")
    assert np.array_equal(vertices, MESH.vertices) and np.array_equal(faces, MESH.faces)
    assert list(maps) == ["depth", "vector", "label"]
    for name, values in maps.items():
        assert values.dtype == np.float64 and np.array_equal(values, ARRAYS[name])


def test_a_last_block_that_is_full_and_one_block_for_all(tmp_path: Path) -> None:
    for block in (8 * 3, 1 << 20):
        (tmp_path / "a.vtp").write_bytes(file_of("raw", "vtkZLibDataCompressor", block=block))
        assert np.array_equal(read_mesh(tmp_path / "a.vtp")[2]["vector"], VALUES)


@pytest.mark.parametrize("name", ["a & b", "Tiefe in m\u00b2", 'the "depth"', "<depth>"])
def test_names_come_back(tmp_path: Path, name: str) -> None:
    write_mesh(tmp_path / "a.vtp", MESH, {name: VALUES[:, 0]})
    assert list(read_mesh(tmp_path / "a.vtp")[2]) == [name]


def test_a_name_may_stand_as_vtk_writes_it(tmp_path: Path) -> None:
    (tmp_path / "a.vtp").write_bytes(file_of(name="a & b"))
    assert "a & b" in read_mesh(tmp_path / "a.vtp")[2]


def test_what_is_packed_otherwise_is_refused_unless_it_is_text(tmp_path: Path) -> None:
    file = file_of("raw", "vtkZLibDataCompressor").replace(b"vtkZLibData", b"vtkLZ4Data")
    (tmp_path / "a.vtp").write_bytes(file)
    with pytest.raises(ValueError, match="packed by 'vtkLZ4DataCompressor', known are vtkZLib"):
        read_mesh(tmp_path / "a.vtp")
    text = "<VTKFile type='PolyData' compressor='vtkLZ4DataCompressor'><Piece><Points><DataArray type='Float64' "
    text += "NumberOfComponents='3' format='ascii'>0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>"
    for name, numbers in {"connectivity": "0 1 2", "offsets": "3"}.items():
        text += f"<DataArray type='Int64' Name='{name}' format='ascii'>{numbers}</DataArray>"
    (tmp_path / "a.vtp").write_text(text + "</Polys></Piece></VTKFile>")
    assert read_mesh(tmp_path / "a.vtp")[1].tolist() == [[0, 1, 2]]


PACKED = file_of("raw", "vtkZLibDataCompressor")
BEGIN = PACKED.index(b" _") + 2


def with_counts(*counts: int) -> bytes:
    """The packed file whose first array begins with these counts."""
    head = np.array(counts, "<u4").tobytes()
    return PACKED[:BEGIN] + head + PACKED[BEGIN + len(head) :]


@pytest.mark.parametrize(
    ("file", "words"),
    [
        (PACKED.replace(b'offset="0"', b'offset="999999"'), "begins at byte '999999' of"),
        (PACKED.replace(b'offset="0"', b'offset="-1"'), "begins at byte '-1' of"),
        (with_counts(1 << 30, BLOCK), "announces 107374182400 bytes, at most"),
        (with_counts(1 << 20, BLOCK), "announces 4194316 bytes and ends before"),
        (with_counts(2, 10, 11), "the last block of an array announces 11 bytes, all others 10"),
        (with_counts(2, 90), "a block of an array announces 90 bytes and has more"),
        (with_counts(2, 110), "a block of an array announces 110 bytes and has 100"),
        (with_counts(2, BLOCK, 68, 7), "a block of an array announces 100 bytes and has "),
        (PACKED.replace(zlib.compress(b"")[:2], b"??"), "a block of an array does not unpack: Error -3"),
        (file_of("raw", "vtkLZMADataCompressor").replace(b"\xfd7zXZ", b"\xfd7zXX"), "does not unpack: Input format"),
        (
            file_of("inline").replace(b'"Float64" Name="vector"', b'"Float32" Name="vector"'),
            "map 'vector' has 84 values",
        ),
        (
            file_of("raw").replace(b'"UInt16" Name="label"', b'"Float64" Name="label"'),
            "has 84 bytes, which are no Float64",
        ),
        (b"<!DOCTYPE x>" + file_of(), "it declares entities, which VTK files do not have"),
        (file_of().replace(b"</Piece>", b"<!ENTITY x></Piece>"), "it declares entities, which VTK files do not have"),
        (file_of().replace(b"Points>", b"Pints>"), "it has no points or no polygons"),
        (file_of().replace(b"Polys>", b"Plys>"), "it has no points or no polygons"),
        (file_of().replace(b'"connectivity"', b'"corners"'), "it has no points or no polygons"),
        (with_counts(2, BLOCK, 66), "announces 66 bytes and has more"),
        (file_of().replace(b'type="Float32"', b'type="Float64"'), "depth' has 21 values for 42 vertices"),
        (file_of().replace(b'type="Float32"', b'type="String"'), "numbers of type 'String', known are Float32"),
        (file_of().replace(b'Components="1"', b'Components="5"', 1), "an array has 42 numbers in 5 components"),
        (file_of().replace(b'Components="1"', b'Components="x"', 1), "an array has 42 numbers in x components"),
        (file_of().replace(b"</DataArray>", b"AAAA</DataArray>", 1), "announces 168 bytes and has more"),
        (file_of().replace(b">qAAAA", b">qQAAA"), "announces 173 bytes and ends before"),
        (file_of().replace(b">qAAAA", b">q%AAA"), "an array is not base64, or ends early"),
        (file_of().replace(b'Strips="0"', b'Strips="2"'), "it announces 2 strips and has 0"),
        (file_of().replace(b"<PolyData>", b"<PolyData><Piece></Piece>"), "it has 2 pieces, one is read: merge them"),
    ],
)
def test_what_a_file_announces_is_checked(tmp_path: Path, file: bytes, words: str) -> None:
    (tmp_path / "a.vtp").write_bytes(file)
    with pytest.raises(ValueError, match=words) as caught:
        read_mesh(tmp_path / "a.vtp")
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


@pytest.mark.parametrize("compressor", list(PACK)[1:])
def test_a_block_is_as_long_as_it_is_announced(compressor: str) -> None:
    block = PACK[compressor](bytes(1001))
    for size in (1000, 1001, 1002):
        data = np.array([1, size, 0, len(block)], "<u4").tobytes() + block
        stream = counted_bytes.CountedBytes(data, False, np.dtype("<u4"))
        if size == 1001:
            assert stream.unpacked(compressor) == bytes(1001)
        else:
            with pytest.raises(ValueError, match=f"announces {size} bytes and has {'more' if size < 1001 else 1001}"):
                stream.unpacked(compressor)


def test_no_more_is_unpacked_than_is_announced(monkeypatch: pytest.MonkeyPatch) -> None:
    """A megabyte that unpacks to a thousand of them."""
    made: list[int] = []
    original = counted_bytes.zlib.decompressobj

    class Counting:
        def __init__(self) -> None:
            self.unpacker = original()

        def decompress(self, data: bytes, most: int) -> bytes:
            block = self.unpacker.decompress(data, most)
            made.append(len(block))
            return block

    monkeypatch.setattr(counted_bytes.zlib, "decompressobj", Counting)
    bomb = zlib.compress(bytes(1 << 24), 9)
    data = np.array([1, 1000, 0, len(bomb)], "<u4").tobytes() + bomb
    with pytest.raises(ValueError, match="announces 1000 bytes and has more"):
        counted_bytes.CountedBytes(data, False, np.dtype("<u4")).unpacked("vtkZLibDataCompressor")
    assert made == [1001]


@pytest.mark.parametrize("mode", MODES)
@given(data=st.data())
def test_a_file_with_wrong_bytes_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, mode: str, data: st.DataObject
) -> None:
    file = bytearray(file_of(mode, data.draw(st.sampled_from(list(PACK)))))
    for place in data.draw(st.lists(st.integers(0, len(file) - 1), min_size=1, max_size=4)):
        file[place] = data.draw(st.integers(0, 255))
    cuts = sorted(data.draw(st.lists(st.integers(0, len(file)), max_size=2)))
    whole = bytes(file) if len(cuts) < 2 else bytes(file[: cuts[0]] + file[cuts[1] :])
    path = tmp_path_factory.mktemp("wrong") / "a.vtp"
    path.write_bytes(whole)
    try:
        read_mesh(path)
    except ValueError as error:
        assert str(error).startswith(str(path)) and "\n" not in str(error)


def test_every_place_where_a_file_is_cut_is_refused(tmp_path: Path) -> None:
    for mode in MODES:
        file = file_of(mode, "vtkZLibDataCompressor")
        for _, end in pairwise(range(0, len(file) - 12, 97)):
            (tmp_path / "a.vtp").write_bytes(file[:end])
            with pytest.raises(ValueError, match=r"a\.vtp"):
                read_mesh(tmp_path / "a.vtp")
