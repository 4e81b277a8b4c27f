"""Whatever bytes provoke in a reader, its user reads one short line that begins with the file's name."""

from __future__ import annotations

import struct
import time
from pathlib import Path

import numpy as np
import pytest

from surfexp.io.cifti import write_cifti_maps
from surfexp.io.declared_sizes import check_declared_sizes
from surfexp.io.entrance import LONGEST_REASON, reading, reason
from surfexp.io.gifti import write_gifti_maps
from surfexp.io.label_files import write_labels
from surfexp.io.map_files import read_maps, read_mask, read_named_labels
from surfexp.io.reading import read_mesh
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.yaml_files import read_yaml

LONG = b"-" + b"\\" * 300 + b"\x00" * 300
PLY = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty %s x\nproperty double y\nproperty double z\nelement face 1\n"
PLY += b"property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
BROKEN = {
    "long.off": b"OFF\n3 1 0\n0 0 " + LONG + b"\n1 0 0\n0 1 0\n3 0 1 2\n",
    "long.vtk": b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 "
    + LONG
    + b"\n1 0 0 0 1 0\n",
    "large.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 " + b"9" * 30 + b"\n",
    "type.ply": PLY % b"ouble",
    "type.vtp": b"<VTKFile type='PolyData'><DataArray type='" + LONG[1:301] + b"'>0</DataArray></VTKFile>",
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_mesh_is_refused_in_one_short_line(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(BROKEN[name])
    with pytest.raises(ValueError, match="cannot be read as a mesh") as refused:
        read_mesh(tmp_path / name)
    line = str(refused.value)
    assert line.startswith(str(tmp_path / name)) and line.isprintable()
    assert len(line) <= len(f"{tmp_path / name} cannot be read as a mesh: ") + LONGEST_REASON


def test_bytes_that_are_no_text_are_named_by_their_place(tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_bytes(b"1\n2\n3\n\xf4")
    with pytest.raises(ValueError, match=r"m\.csv cannot be read as a scalar map: byte 6 is no UTF-8 text$"):
        read_maps(tmp_path / "m.csv")


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ValueError("why\nhow"), "why"),
        (ValueError(), "ValueError"),
        (MemoryError("Unable to allocate 5.25 PiB"), "it says that it holds more than there is memory for"),
        (OverflowError("Python int too large"), "it holds a number that is too large"),
        (KeyError("ouble"), "what it holds does not fit together (KeyError 'ouble')"),
        (FileNotFoundError(2, "No such file"), "[Errno 2] No such file"),
        (ValueError("a\x1b[31m\u202eb"), r"a\x1b[31m\u202eb"),
        (ValueError("x" * 500), "x" * 196 + " ..."),
    ],
)
def test_reasons(error: Exception, said: str) -> None:
    assert reason(error) == said
    with pytest.raises(ValueError, match="no file") as refused, reading("a.x", "is no file"):
        raise error
    assert str(refused.value) == f"a.x is no file: {said}"


def test_an_interrupt_is_no_refusal() -> None:
    with pytest.raises(KeyboardInterrupt), reading("a.x", "is no file"):
        raise KeyboardInterrupt


def test_a_gifti_file_that_lies_before_it_breaks_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "m.shape.gii"
    write_gifti_maps(path, {"height": np.arange(42.0)}, "left")
    spoilt = path.read_bytes().replace(b'Dimensionality="1"', b'Dimensionality="' + b"9" * 40 + b'"')
    path.write_bytes(spoilt[: spoilt.index(b"</DataArray>")] + b"<?xml version=")
    begin = time.monotonic()
    with pytest.raises(ValueError, match="Dimensionality"):
        read_maps(path)
    assert time.monotonic() - begin < 5.0


@pytest.mark.parametrize("kind", [0, 16, 1792])
def test_cifti_extents_are_judged_by_the_type_that_the_reader_believes(tmp_path: Path, kind: int) -> None:
    path = tmp_path / "m.dscalar.nii"
    write_cifti_maps(path, {"height": np.arange(42.0)}, "left")
    check_declared_sizes(path)
    whole = bytearray(path.read_bytes())
    struct.pack_into("<hh", whole, 12, kind, 0)
    extents = struct.unpack_from("<8q", whole, 16)
    struct.pack_into("<8q", whole, 16, *extents[:5], 1 << 44, *extents[6:])
    path.write_bytes(whole)
    with pytest.raises(ValueError, match="bytes of data"):
        check_declared_sizes(path)


def annotation(tmp_path: Path) -> Path:
    path = tmp_path / "lh.p.annot"
    write_labels(path, np.arange(12) % 3, ["unknown", "low", "high"])
    return path


def test_every_count_of_an_annotation_is_held_against_its_length(tmp_path: Path) -> None:
    path = annotation(tmp_path)
    whole = path.read_bytes()
    assert read_named_labels(path).names == {0: "unknown", 1: "low", 2: "high"}
    refused = 0
    for at in range(0, len(whole) - 4):
        spoilt = bytearray(whole)
        struct.pack_into(">i", spoilt, at, 0x7FFFFFF0)
        path.write_bytes(spoilt)
        begin = time.monotonic()
        try:
            read_named_labels(path)
        except ValueError as error:
            refused += 1
            assert len(str(error)) < 300 + len(str(path))
        assert time.monotonic() - begin < 5.0
    assert refused > 20


def test_an_annotation_of_the_first_format_passes_and_lies_are_refused(tmp_path: Path) -> None:
    def entry(name: bytes, *color: int) -> bytes:
        return struct.pack(">i", len(name)) + name + struct.pack(">4i", *color)

    keys = b"".join(struct.pack(">2i", vertex, 1 + 256 * 2 + 65536 * 3) for vertex in range(4))
    table = struct.pack(">3i", 1, 1, 3) + b"lut" + entry(b"low\0", 1, 2, 3, 0)
    path = tmp_path / "lh.old.annot"
    path.write_bytes(struct.pack(">i", 4) + keys + table)
    assert read_named_labels(path).keys.tolist() == [0, 0, 0, 0]
    path.write_bytes(struct.pack(">i", 4) + keys + table.replace(struct.pack(">i", 3) + b"lut", b"\x7f\0\0\0lut"))
    with pytest.raises(ValueError, match="the length of a name is 2130706432, 0 to"):
        read_named_labels(path)


@pytest.mark.parametrize("suffix", [".mgh", ".mgz"])
def test_a_volume_that_is_shorter_than_its_header_says_is_refused(tmp_path: Path, suffix: str) -> None:
    import gzip

    from surfexp.io.freesurfer import write_volume_map

    path = tmp_path / f"m{suffix}"
    write_volume_map(path, np.arange(42.0))
    assert read_maps(path)["m"].shape == (42,)
    opened = gzip.open if suffix == ".mgz" else open
    with opened(path, "rb") as stream:
        whole = bytearray(stream.read())
    struct.pack_into(">i", whole, 4, 1 << 30)
    with opened(path, "wb") as stream:
        stream.write(bytes(whole))
    with pytest.raises(ValueError, match="its header says 4294967296 bytes of data"):
        read_maps(path)


def test_a_vertex_below_zero_is_named(tmp_path: Path) -> None:
    (tmp_path / "lh.a.label").write_text("#!ascii label\n1\n-7 0 0 0 0\n")
    with pytest.raises(ValueError, match=r"names vertex -7, the surface has 0\.\.41"):
        read_mask(tmp_path / "lh.a.label", 42)


def test_what_is_no_yaml_is_said_to_be_none(tmp_path: Path) -> None:
    (tmp_path / "e.yaml").write_text("title: 'open\n")
    with pytest.raises(UserError, match="line 2: not YAML: found unexpected end of stream"):
        read_yaml(tmp_path / "e.yaml")
