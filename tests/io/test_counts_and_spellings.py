"""Counts that a text announces and does not keep, spellings that formats allow, and texts that took hours."""

from __future__ import annotations

import struct
import time
from pathlib import Path

import numpy as np
import pytest

from surfexp.io.label_files import read_label_map
from surfexp.io.map_files import read_mask
from surfexp.io.reading import read_mesh, read_mesh_file

SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face {}\nproperty list uchar int vertex_indices\n{}end_header\n"
)


def annotation(entries: dict[int, tuple[bytes, tuple[int, int, int]]], values: list[int]) -> bytes:
    """A file of FreeSurfer's second version, whose table leaves numbers out."""
    data = struct.pack(">i", len(values)) + b"".join(struct.pack(">ii", k, value) for k, value in enumerate(values))
    data += (
        struct.pack(">iii", 1, -2, max(entries) + 1) + struct.pack(">i", 4) + b"lut\0" + struct.pack(">i", len(entries))
    )
    for number, (name, colour) in entries.items():
        data += struct.pack(">ii", number, len(name) + 1) + name + b"\0" + struct.pack(">4i", *colour, 0)
    return data


def test_labels_of_a_table_with_gaps_keep_their_names(tmp_path: Path) -> None:
    colours = {0: (b"unknown", (25, 5, 25)), 5: (b"B", (60, 20, 220)), 2: (b"A", (25, 100, 40))}
    packed = {name: r + (g << 8) + (b << 16) for name, (r, g, b) in colours.values()}
    path = tmp_path / "lh.a.annot"
    path.write_bytes(annotation(colours, [packed[b"A"], packed[b"B"], packed[b"unknown"], 0, packed[b"B"]]))
    found = read_label_map(path)
    assert [found.names.get(int(key)) for key in found.keys] == ["A", "B", "unknown", None, "B"]
    assert found.keys.tolist() == [2, 5, 0, -1, 5]
    assert read_mask(path, 5).tolist() == [True, True, False, False, True]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.off", f"OFF\n4 1 0\n{SQUARE}3 0 1 2\n3 0 2 3\n", "counts are wrong"),
        ("a.ply", PLY.format(1, "") + SQUARE + "3 0 1 2\n3 0 2 3\n", "declared"),
        ("a.ply", PLY.format(1, "") + SQUARE.replace("\n", " 7\n") + "3 0 1 2\n3 0 2 3\n", "declared"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4"),
    ],
)
def test_faces_beyond_the_count_and_corners_before_the_first_are_refused(
    tmp_path: Path, name: str, text: str, said: str
) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=said):
        read_mesh(tmp_path / name)


def test_what_ply_says_of_faces_is_named_as_passed_over(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_text(PLY.format(1, "property int label\n") + SQUARE + "3 0 1 2 9\n")
    assert "Properties of faces are passed over: label." in read_mesh_file(tmp_path / "a.ply").notes


def test_a_triangle_that_is_written_with_four_corners_is_one(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 3\nf 1 3 4 1\n")
    assert read_mesh(tmp_path / "a.obj")[1].tolist() == [[0, 1, 2], [0, 2, 3]]


def test_a_legacy_file_may_have_no_title(tmp_path: Path) -> None:
    body = f"ASCII\nDATASET POLYDATA\nPOINTS 4 float\n{SQUARE}POLYGONS 2 8\n3 0 1 2\n3 0 2 3\n"
    (tmp_path / "a.vtk").write_text(f"# vtk DataFile Version 3.0\n\n{body}")
    assert read_mesh(tmp_path / "a.vtk")[1].tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "a.vtk",
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nFIELD f 1\ns 1 1000000000000000 string\n",
        ),
        (
            "a.vtp",
            '<VTKFile type="PolyData"><PolyData><Piece><Points>'
            + "<DataArray>" * 10**5
            + "</Points></Piece></PolyData></VTKFile>",
        ),
        ("a.vtp", f'<VTKFile type="PolyData" {"a" * 10**6}></VTKFile>'),
        ("a.stl", "solid a\n" + "\n" * 10**6 + "facet\nendsolid"),
    ],
)
def test_texts_of_a_megabyte_are_refused_in_seconds(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    begin = time.process_time()
    with pytest.raises(ValueError, match=name):
        read_mesh(tmp_path / name)
    assert time.process_time() - begin < 5.0


def test_a_polygon_whose_corners_coincide_does_not_take_a_turn_for_each_of_them(tmp_path: Path) -> None:
    count = 10000
    turns = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    points = np.stack([np.cos(turns) * (1.0 + 0.1 * np.cos(9 * turns)), np.sin(turns), 0.0 * turns], axis=1)
    points[1] = points[0]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    (tmp_path / "a.obj").write_text("\n".join([*lines, "f " + " ".join(map(str, range(1, count + 1)))]))
    begin = time.process_time()
    read_mesh_file(tmp_path / "a.obj")
    assert time.process_time() - begin < 10.0
