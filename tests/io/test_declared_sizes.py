"""Files that lie about sizes end in a line at once, before a parser believes them; sound files pass."""

from __future__ import annotations

import base64
import gzip
import re
import struct
import time
import tracemalloc
import zipfile
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from surfexp.io.cifti import write_cifti_maps
from surfexp.io.declared_sizes import HEADER, check_declared_sizes
from surfexp.io.gifti import write_gifti_labels, write_gifti_maps
from surfexp.io.hemisphere import hemisphere_of_file
from surfexp.io.map_files import read_maps, read_mask, read_named_labels
from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import SHOWN_KINDS, require_valid, validate

MESH = icosphere(1).mesh
VALUES = np.linspace(0.0, 1.0, len(MESH.vertices))


@pytest.fixture
def cifti(tmp_path: Path) -> Path:
    path = tmp_path / "a.dscalar.nii"
    write_cifti_maps(path, {"thickness": VALUES}, "left")
    return path


def with_bytes(path: Path, place: int, content: bytes) -> Path:
    whole = bytearray(path.read_bytes())
    whole[place : place + len(content)] = content
    path.write_bytes(whole)
    return path


@pytest.mark.parametrize("dimensions", ["4294967296", "-1", "0", "x", "7"])
@pytest.mark.parametrize("name", ["a.surf.gii", "a.shape.gii", "a.shape.gii.gz", "a.label.gii"])
def test_a_gifti_array_with_impossible_dimensions_is_refused_at_once(
    tmp_path: Path, name: str, dimensions: str
) -> None:
    sound = tmp_path / name.removesuffix(".gz")
    if "surf" in name:
        write_mesh(sound, MESH)
    elif "label" in name:
        write_gifti_labels(sound, np.arange(len(MESH.vertices)) % 2, {0: "a", 1: "b"}, np.zeros((2, 3), np.int64), "")
    else:
        write_gifti_maps(sound, {"thickness": VALUES}, "left")
    check_declared_sizes(sound)
    spoilt, count = re.subn(
        rb'Dimensionality="\d"', f'Dimensionality="{dimensions}"'.encode(), sound.read_bytes(), count=1
    )
    assert count == 1
    path = tmp_path / name
    path.write_bytes(gzip.compress(spoilt) if name.endswith("gz") else spoilt)
    begin = time.monotonic()
    read = read_mesh if "surf" in name else read_named_labels if "label" in name else read_maps
    with pytest.raises(ValueError, match=re.escape(f"Dimensionality '{dimensions}', 1 to 6 are possible")):
        read(path)
    if "surf" in name:
        with pytest.raises(ValueError, match="1 to 6 are possible"):
            hemisphere_of_file(path)
    assert time.monotonic() - begin < 60.0


@pytest.mark.parametrize("place", [0.2, 0.5, 0.9])
def test_a_spoilt_archive_is_left_to_the_reader_which_refuses_it(tmp_path: Path, place: float) -> None:
    path = tmp_path / "a.shape.gii"
    write_gifti_maps(path, {"thickness": np.random.default_rng(0).normal(size=len(MESH.vertices))}, "left")
    whole = bytearray(gzip.compress(path.read_bytes()))
    begin = int(place * len(whole))
    whole[begin : begin + 40] = bytes(40)
    spoilt = tmp_path / "a.shape.gii.gz"
    spoilt.write_bytes(whole)
    check_declared_sizes(spoilt)
    with pytest.raises(ValueError, match="it is not a readable GIFTI file"):
        read_maps(spoilt)


def test_a_gifti_array_of_too_many_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.shape.gii"
    write_gifti_maps(path, {"thickness": VALUES}, "left")
    path.write_bytes(re.sub(rb'Dim0="\d+"', b'Dim0="99999999999"', path.read_bytes()))
    with pytest.raises(ValueError, match="Dim0 '99999999999', at most 268435456 are read"):
        read_maps(path)


def external(path: Path, name: str, count: int = len(VALUES), encoding: str = "ExternalFileBinary") -> Path:
    """A GIFTI map whose bytes lie in another file."""
    path.write_text(
        '<?xml version="1.0"?><GIFTI Version="1.0" NumberOfDataArrays="1"><DataArray Intent="NIFTI_INTENT_NONE" '
        'DataType="NIFTI_TYPE_FLOAT32" ArrayIndexingOrder="RowMajorOrder" Dimensionality="1" '
        f'Dim0="{count}" Encoding="{encoding}" Endian="LittleEndian" ExternalFileName="{name}" ExternalFileOffset="0">'
        "<Data/></DataArray></GIFTI>"
    )
    return path


@pytest.mark.parametrize("encoding", ["ExternalFileBinary", "External", "GIFTI_ENCODING_EXTBIN"])
def test_an_array_in_another_file_is_read_from_the_same_folder_alone(tmp_path: Path, encoding: str) -> None:
    own = tmp_path / "own"
    own.mkdir()
    for folder in (tmp_path, own):
        VALUES.astype("<f4").tofile(folder / "map.dat")
    (own / "link.dat").symlink_to(tmp_path / "map.dat")
    np.testing.assert_array_equal(
        next(iter(read_maps(external(own / "a.shape.gii", "map.dat", encoding=encoding)).values())), VALUES.astype("f4")
    )
    for name in (str(tmp_path / "map.dat"), "../map.dat", "link.dat", "", ".", "missing.dat", "own/../map.dat"):
        path = external(own / "a.shape.gii", name, encoding=encoding)
        for read in (read_maps, hemisphere_of_file):
            with pytest.raises(ValueError, match="external file"):
                read(path)


@pytest.mark.parametrize("encoding", ["GZipBase64Binary", "B64GZ", None])
def test_an_array_that_unpacks_to_a_thousand_times_its_file_is_refused(
    tmp_path: Path, encoding: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("surfexp.io.unpacked_sizes.ALWAYS_READ", 1 << 20)
    path = external(tmp_path / "a.shape.gii", "", encoding="GZipBase64Binary")
    packed = base64.b64encode(zlib.compress(bytes(1 << 26))).decode()
    text = path.read_text().replace("<Data/>", f"<Data>{packed}</Data>")
    said = f'Encoding="{encoding}" ' if encoding else ""
    path.write_text(text.replace('Encoding="GZipBase64Binary" ', said))
    tracemalloc.start()
    with pytest.raises(ValueError, match="unpacked it has over"):
        read_maps(path)
    assert tracemalloc.get_traced_memory()[1] < 1 << 24
    tracemalloc.stop()


@pytest.mark.parametrize("order", "<>")
def test_the_head_of_cifti_is_read_in_both_orders_of_bytes(cifti: Path, order: str) -> None:
    head = bytearray(cifti.read_bytes()[: HEADER + 4])
    values = (
        struct.unpack_from("<h", head, 14),
        struct.unpack_from("<8q", head, 16),
        struct.unpack_from("<q", head, 168),
    )
    struct.pack_into(f"{order}i", head, 0, HEADER)
    for form, place, numbers in zip(("h", "8q", "q"), (14, 16, 168), values, strict=True):
        struct.pack_into(f"{order}{form}", head, place, *numbers)
    head[HEADER] = 0  # no extensions
    with_bytes(cifti, 0, bytes(head))
    check_declared_sizes(cifti)
    struct.pack_into(f"{order}q", head, 16 + 8 * 6, 2**40)
    with pytest.raises(ValueError, match="bytes of data from byte"):
        check_declared_sizes(with_bytes(cifti, 0, bytes(head)))


@pytest.mark.parametrize("length", [0, 8, -16, 2**31 - 1])
def test_an_extension_of_impossible_length_is_refused_at_once(cifti: Path, length: int) -> None:
    assert read_maps(cifti, "left")["thickness"] == pytest.approx(VALUES, abs=1e-6)
    with pytest.raises(ValueError, match=rf"an extension of its header has {length} bytes"):
        read_maps(with_bytes(cifti, HEADER + 4, struct.pack("<i", length)), "left")


@pytest.mark.parametrize("name", ["SurfaceNumberOfVertices", "IndexCount"])
def test_declared_vertices_beyond_reason_are_refused_before_room_is_made(cifti: Path, name: str) -> None:
    whole = cifti.read_bytes()
    found = re.search(f'{name}="(\\d+)"( *)'.encode(), whole)
    assert found
    digits = b"9" * len(found[1])
    large = whole.replace(found[0], found[0].replace(found[1], digits))
    cifti.write_bytes(large)
    if (
        len(digits) < 9
    ):  # the number has no room to be too large without a longer text: make it one, and the rest shorter
        longer = found[0].replace(found[1], b"9" * 12)
        spare = re.search(rb"<MetaData>.*?</MetaData>|\s{10,}|\x00{10,}", whole[found.end() :], re.DOTALL)
        assert spare
        cut = len(longer) - len(found[0])
        place = found.end() + spare.end() - cut
        cifti.write_bytes(whole[: found.start()] + longer + whole[found.end() : place] + whole[place + cut :])
    with pytest.raises(ValueError, match=f"its {name} is 9+, at most 67108864 are read"):
        read_maps(cifti, "left")


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(place=st.integers(0, HEADER + 12), value=st.integers(0, 255))
def test_any_byte_of_a_cifti_head_may_be_wrong(cifti: Path, place: int, value: int) -> None:
    sound = cifti.read_bytes()
    try:
        found = read_maps(with_bytes(cifti, place, bytes([value])), "left")
        assert all(len(values) == len(MESH.vertices) for values in found.values())
    except ValueError as error:
        assert len(str(error).replace(str(cifti), "")) < 300 and "\n" not in str(error)
    finally:
        cifti.write_bytes(sound)


def test_spoilt_arrays_of_numpy_are_refused_in_a_line(tmp_path: Path) -> None:
    path = tmp_path / "a.npy"
    np.save(path, VALUES)
    whole = path.read_bytes()
    path.write_bytes(whole[:64] + bytes(len(whole) - 64))
    archive = tmp_path / "a.npz"
    np.savez_compressed(archive, thickness=np.random.default_rng(0).normal(size=500))
    with zipfile.ZipFile(archive) as opened:
        begin = opened.infolist()[0].header_offset + 60
    with_bytes(archive, begin, b"\xff" * 40)
    for file in (path, archive):
        with pytest.raises(ValueError, match="it is not a readable array file") as caught:
            read_maps(file)
        assert "\n" not in str(caught.value)


def test_masks_and_labels_are_checked_too(tmp_path: Path) -> None:
    path = tmp_path / "a.label.gii"
    write_gifti_labels(path, np.arange(len(MESH.vertices)) % 2, {0: "unknown", 1: "b"}, np.zeros((2, 3), np.int64), "")
    assert read_mask(path, len(MESH.vertices)).sum() == len(MESH.vertices) // 2
    path.write_bytes(path.read_bytes().replace(b'Dimensionality="1"', b'Dimensionality="4294967296"'))
    with pytest.raises(ValueError, match="not a readable file of labels: a data array has Dimensionality"):
        read_mask(path, len(MESH.vertices))


def test_a_refusal_of_a_mesh_with_every_defect_is_one_short_line() -> None:
    vertices = np.zeros((42, 3))
    faces = np.concatenate([MESH.faces, MESH.faces[:3], [[0, 0, 1]], MESH.faces[:1, ::-1]])
    kinds = [item for item in validate(vertices, faces).defects if item.severity == "repairable"]
    assert len(kinds) > SHOWN_KINDS
    with pytest.raises(ValueError, match=f"{len(kinds) - SHOWN_KINDS} more kinds of defects") as caught:
        require_valid(TriangleMesh(vertices, faces), "a.off")
    assert len(str(caught.value)) < 300 and all(str(kind) in str(caught.value) for kind in kinds[:SHOWN_KINDS])
