"""Files as other programs write them: each dialect gives the same surface."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from surfexp.io import polygons
from surfexp.io.ply import write_ply
from surfexp.io.polygons import triangulate
from surfexp.io.reading import read_mesh, read_mesh_file
from surfexp.io.vtp import write_vtp
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

MESH = icosphere(1).mesh
V, F = MESH.vertices, MESH.faces
N, M = len(V), len(F)
ROWS = [" ".join(map(repr, row)) for row in V.tolist()]
FACES = ["3 " + " ".join(map(str, row)) for row in F.tolist()]
POINTS = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n" + f"POINTS {N} double\n" + "\n".join(ROWS) + "\n"
POLYGONS = f"POLYGONS {M} {4 * M}\n" + "\n".join(FACES) + "\n"
DEPTH = f"SCALARS depth double\nLOOKUP_TABLE default\n{' '.join(map(str, range(N)))}\n"


def numbers(count: int) -> str:
    return " ".join(["0.5"] * count) + "\n"


def lines(*parts: str) -> str:
    return "\n".join([*parts, ""])


SECTIONS = {
    "normals": f"POINT_DATA {N}\nNORMALS n float\n{numbers(3 * N)}" + DEPTH,
    "vectors": f"POINT_DATA {N}\nVECTORS v double\n{numbers(3 * N)}" + DEPTH,
    "tensors": f"POINT_DATA {N}\nTENSORS t float\n{numbers(9 * N)}" + DEPTH,
    "colours": f"POINT_DATA {N}\nCOLOR_SCALARS c 4\n{numbers(4 * N)}" + DEPTH,
    "texture": f"POINT_DATA {N}\nTEXTURE_COORDINATES t 2 float\n{numbers(2 * N)}" + DEPTH,
    "table": f"POINT_DATA {N}\n{DEPTH}LOOKUP_TABLE t 5\n{numbers(20)}",
    "cells first": f"CELL_DATA {M}\nSCALARS c int 1\nLOOKUP_TABLE default\n{' '.join(['7'] * M)}\nPOINT_DATA {N}\n{DEPTH}",
    "metadata": f"METADATA\nCOMPONENT_NAMES\nX%20y\nINFORMATION 1\nNAME a LOCATION b\nDATA 1 2\n\nPOINT_DATA {N}\n{DEPTH}",
    "text": f"POINT_DATA {N}\n{DEPTH}FIELD FieldData 1\ns 1 {N} string\n" + "a b\n" * N,
    "identities": f"POINT_DATA {N}\nPEDIGREE_IDS i vtkIdType\n{' '.join(['7'] * N)}\n{DEPTH}",
}


@pytest.mark.parametrize("kind", SECTIONS)
def test_sections_of_known_length_are_passed_over(tmp_path: Path, kind: str) -> None:
    (tmp_path / "a.vtk").write_text(POINTS + POLYGONS + SECTIONS[kind])
    vertices, faces, maps = read_mesh(tmp_path / "a.vtk")
    assert np.array_equal(vertices, V) and np.array_equal(faces, F)
    assert maps["depth"].tolist() == list(range(N))
    (tmp_path / "a.vtk").write_text(POINTS + POLYGONS + SECTIONS[kind] + "SOMETHING else 3\n")
    with pytest.raises(ValueError, match="SOMETHING"):
        read_mesh(tmp_path / "a.vtk")


def test_triangles_of_an_unstructured_grid_are_read_and_volumes_refused(tmp_path: Path) -> None:
    grid = POINTS.replace("POLYDATA", "UNSTRUCTURED_GRID") + POLYGONS.replace("POLYGONS", "CELLS")
    (tmp_path / "a.vtk").write_text(f"{grid}CELL_TYPES {M}\n" + "5\n" * M)
    assert np.array_equal(read_mesh(tmp_path / "a.vtk")[1], F)
    (tmp_path / "a.vtk").write_text(f"{grid}CELL_TYPES {M}\n" + "5\n" * (M - 1) + "10\n")
    with pytest.raises(ValueError, match="extract the surface first"):
        read_mesh(tmp_path / "a.vtk")


def test_strips_of_vtk_are_cut_into_triangles(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_text(POINTS + "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\n")
    assert read_mesh(tmp_path / "a.vtk")[1].tolist() == [[0, 1, 2], [2, 1, 3]]


OFF = {
    "glued": f"OFF{N} {M} 0\n" + lines(*ROWS, *FACES),
    "no header": f"{N} {M} 0\n" + lines(*ROWS, *FACES),
    "no edges": f"OFF\n{N} {M}\n" + lines(*ROWS, *FACES),
    "words": f"OFF {N} {M} 0 " + " ".join([*ROWS, *FACES]) + "\n",
    "two a line": f"OFF\n{N} {M} 0\n" + lines(*(" ".join(ROWS[k : k + 2]) for k in range(0, N, 2)), *FACES),
    "colours": f"COFF\n{N} {M} 0\n"
    + lines(*(f"{row} 255 0 0 255" for row in ROWS), *(f"{row} 1 0 0" for row in FACES)),
    "homogeneous": f"4OFF\n{N} {M} 0\n" + lines(*(" ".join(map(repr, [*(2 * r).tolist(), 2.0])) for r in V), *FACES),
    "dimension": f"nOFF 3\n{N} {M} 0\n" + lines(*ROWS, *FACES),
}


@pytest.mark.parametrize("text", ["OFF\n", "OFF\n4\n", "OFF 4\n"])
def test_off_without_its_counts_is_refused_by_name(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.off").write_text(text)
    with pytest.raises(ValueError, match="the counts of vertices and faces are missing"):
        read_mesh(tmp_path / "a.off")


@pytest.mark.parametrize("kind", OFF)
def test_dialects_of_off(tmp_path: Path, kind: str) -> None:
    (tmp_path / "a.off").write_text(OFF[kind])
    vertices, faces, _ = read_mesh(tmp_path / "a.off")
    assert np.allclose(vertices, V, rtol=1e-15, atol=0) and np.array_equal(faces, F)


@pytest.mark.parametrize(
    ("head", "words"), [("nOFF 4", "dimension"), ("OFF BINARY", "binary OFF file"), ("GOFF", "OFF")]
)
def test_other_off_files_are_refused(tmp_path: Path, head: str, words: str) -> None:
    (tmp_path / "a.off").write_text(f"{head}\n{N} {M} 0\n" + lines(*ROWS, *FACES))
    with pytest.raises(ValueError, match=words):
        read_mesh(tmp_path / "a.off")


PLY = f"ply\nformat ascii 1.0\nelement vertex {N}\nproperty double x\nproperty double y\nproperty double z\n"
PLY_FACES = f"element face {M}\nproperty list uchar int vertex_indices\nend_header\n"
EXTRA = "property list uchar float weights\n"
PLYS = {
    "comment": PLY.replace("element vertex", "comment before end_header\nelement vertex")
    + PLY_FACES
    + lines(*ROWS, *FACES),
    "more in a row": PLY + PLY_FACES + lines(*ROWS, *(f"{row} 255 0 0" for row in FACES)),
    "list at vertices": PLY + EXTRA + PLY_FACES + lines(*(f"{row} 2 0.5 0.25" for row in ROWS), *FACES),
    "carriage returns": (PLY + PLY_FACES + lines(*ROWS, *FACES)).replace("\n", "\r"),
}


@pytest.mark.parametrize("kind", PLYS)
def test_dialects_of_ascii_ply(tmp_path: Path, kind: str) -> None:
    (tmp_path / "a.ply").write_bytes(PLYS[kind].encode())
    vertices, faces, maps = read_mesh(tmp_path / "a.ply")
    assert np.array_equal(vertices, V) and np.array_equal(faces, F) and not maps


def stl_text(name: str) -> str:
    facets = [
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {ROWS[k]}\n" for k in f) + "endloop\nendfacet" for f in F
    ]
    return lines(f"solid {name}", *facets, f"endsolid {name}")


@pytest.mark.parametrize("text", [stl_text("a"), stl_text("a").upper(), stl_text("a vertex 1 2 3 facet normal")])
def test_dialects_of_stl(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.stl").write_text(text)
    vertices, faces, _ = read_mesh(tmp_path / "a.stl")
    assert np.array_equal(vertices[faces], V[F])


def test_bytes_behind_a_binary_stl_are_said_and_a_wrong_count_is_refused(tmp_path: Path) -> None:
    corners = np.zeros(M, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    corners["corners"] = V[F]
    for count, more in ((M, b"tail"), (M - 1, b"")):
        (tmp_path / "a.stl").write_bytes(b" " * 80 + count.to_bytes(4, "little") + corners.tobytes() + more)
        if more:
            assert "4 bytes behind" in read_mesh_file(tmp_path / "a.stl").notes[0]
        else:
            with pytest.raises(ValueError, match="its count is wrong"):
                read_mesh(tmp_path / "a.stl")


def test_dialects_of_obj(tmp_path: Path) -> None:
    body = lines(*(f"v {row}" for row in ROWS), "mg 0", "$ odd", *(f"f {a} {b} {c}" for a, b, c in F + 1))
    (tmp_path / "a.obj").write_text(body, encoding="utf-8-sig")
    found = read_mesh_file(tmp_path / "a.obj")
    assert np.array_equal(found.vertices, V) and np.array_equal(found.faces, F)
    assert found.notes == ("1 statements of unknown kinds are passed over: '$'.",)
    ends = " ".join(map(str, 3 * np.arange(1, M + 1)))
    mni = lines(f"P 0.3 0.3 0.4 10 1 {N}", *ROWS, *ROWS, str(M), "0 1 1 1 1", ends, " ".join(map(str, F.ravel())))
    (tmp_path / "a.obj").write_text(mni)
    found = read_mesh_file(tmp_path / "a.obj")
    assert np.array_equal(found.vertices, V) and np.array_equal(found.faces, F)


def shoelace(x: np.ndarray, y: np.ndarray) -> float:
    return float(abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2)


@pytest.mark.parametrize("seed", range(20))
def test_concave_polygons_keep_their_area_normal_and_corners(seed: int) -> None:
    random = np.random.default_rng(seed)
    count = int(random.integers(4, 30))
    angles = np.sort(random.uniform(0, 2 * np.pi, count))
    gap = np.diff(angles, append=angles[0] + 2 * np.pi)
    if gap.max() > np.pi:  # not around the centre
        angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    radius = random.uniform(0.2, 1.0, count)
    x, y = radius * np.cos(angles), radius * np.sin(angles)
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    points = np.column_stack([x, y, np.zeros(count)]) @ turn.T + 5.0
    for start in range(0, count, 3):
        polygon = np.roll(np.arange(count), -start)
        faces, notes = triangulate([polygon.tolist()], points)
        mesh = TriangleMesh(points, faces)
        assert notes == () and len(faces) == count - 2 and np.array_equal(np.unique(faces), np.arange(count))
        assert mesh.area == pytest.approx(shoelace(x, y), rel=1e-12)
        vectors = mesh.face_cross_products
        assert (vectors @ vectors.sum(axis=0) > 0).all()


def test_a_vertex_on_a_straight_side_stays_a_corner() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 2, 0], [1, 0.5, 0], [0, 2, 0]])
    for start in range(6):
        faces, _ = triangulate([np.roll(np.arange(6), start).tolist()], points)
        assert len(faces) == 4 and TriangleMesh(points, faces).areas.min() > 0.1
    # the first ears that are cut of it make a triangle without area
    x = np.array([6, 3, 1.5, 0, -9, -7.5, -6, -5, 0, 3])
    y = np.array([0, 1, 3.5, 6, 2, 1, 0, -3, -9, -4.5])
    faces, _ = triangulate([list(range(10))], points := np.column_stack([x, y, 0 * x]))
    assert len(faces) == 8 and TriangleMesh(points, faces).areas.min() > 0.1


@pytest.mark.parametrize("kind", ["crossing", "around"])
def test_a_long_polygon_that_runs_over_itself_ends_soon(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    ears = polygons.triangulate_float64

    def counted(*arguments: np.ndarray) -> np.ndarray:
        calls.append(1)
        return ears(*arguments)

    monkeypatch.setattr(polygons, "triangulate_float64", counted)
    angle = np.linspace(0.0, 2.0 * np.pi, 800, endpoint=False)
    points = np.c_[np.sin(2.0 * angle), np.sin(3.0 * angle + 0.3), 0.0 * angle]
    corners = list(range(800)) if kind == "crossing" else [0, 200, 400, 600] * 100
    faces, notes = triangulate([corners], points)
    assert len(faces) == len(corners) - 2
    assert "cross themselves" in notes[0]
    assert len(calls) <= (64 if kind == "crossing" else 2)


def test_sound_ears_are_found_however_late_they_come(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first 80 cuts are fans around a vertex of a straight side: of the right area, with triangles without area."""
    side = np.c_[np.linspace(0.0, 1.0, 100, endpoint=False), np.zeros((100, 2))]
    points = np.vstack([side, [[1, 0, 0], [1, 1, 0], [0, 1, 0]]])
    ears, calls = polygons.triangulate_float64, []

    def late(plane: np.ndarray, ends: np.ndarray) -> np.ndarray:
        calls.append(1)
        place = np.arange(1, len(plane) - 1)
        return np.c_[0 * place, place, place + 1].ravel() if len(calls) <= 80 else ears(plane, ends)

    monkeypatch.setattr(polygons, "triangulate_float64", late)
    faces, notes = triangulate([list(range(103))], points)
    mesh = TriangleMesh(points, faces)
    assert notes == () and len(calls) == 81
    assert mesh.areas.min() > 1e-4 and mesh.area == pytest.approx(1.0, rel=1e-12)


def test_bent_and_crossing_polygons_are_said() -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
    assert "1 polygons are bent" in triangulate([[0, 1, 2, 3]], square)[1][0]
    bow = np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0]])
    assert "cross themselves" in triangulate([[0, 1, 2, 3]], bow)[1][0]


def test_counts_beyond_the_file_are_refused_before_room_is_made(tmp_path: Path) -> None:
    path = tmp_path / "a.off"
    path.write_text("OFF\n353535235358 6 0\n0 0 0\n1 0 0\n0 1 0\n")
    with pytest.raises(ValueError, match="ends after 3 of 353535235358 vertices"):
        read_mesh(path)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n"),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"),
        ("b.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                  "end_header\n0 0 0\n1 0 0\n0 1 0\n"),
        ("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n"),
    ],
)  # fmt: skip
def test_points_alone_say_how_to_go_on(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(
        ValueError, match=r"3 points without faces: make a surface .* \(surfexp info surface/point_cloud\)"
    ):
        read_mesh(tmp_path / name)


def test_a_list_among_numbers_that_is_none_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    head = (
        "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty list uchar int vertex_indices"
    )
    path.write_text(f"ply\nformat ascii 1.0\n{head}\nend_header\n0 0 0 7.5\n")
    with pytest.raises(
        ValueError, match=r"entry 0 of 'vertex' has '7\.5' where the length of 'vertex_indices' is needed"
    ):
        read_mesh(path)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_an_obj_of_windows_is_read(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "a.obj"
    path.write_bytes("\ufeffv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".encode(encoding))
    vertices, faces, _ = read_mesh(path)
    assert len(vertices) == 3 and faces.tolist() == [[0, 1, 2]]


def test_what_geomview_says_before_off_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "a.off"
    path.write_text("appearance {\n +texturing # }\n texture { file grid.pgm.gz }\n}\nSTOFF\n3 1 3\n"
                    "0 0 0 .5 1\n1 0 0 .5 1\n0 1 0 .5 1\n3 0 1 2\n")  # fmt: skip
    vertices, faces, _ = read_mesh(path)
    assert vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]] and faces.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("last", ["0", "-1"])
def test_a_surface_in_four_dimensions_is_refused(tmp_path: Path, last: str) -> None:
    path = tmp_path / "a.off"
    path.write_text(f"4OFF\n3 1 3\n0 0 0 1\n1 0 0 2\n0 1 0 {last}\n3 0 1 2\n")
    with pytest.raises(ValueError, match=rf"numbers from {last} to 2, positive ones are needed"):
        read_mesh(path)


def test_maps_of_cells_are_named_where_they_are_passed_over(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_text(POINTS + POLYGONS + SECTIONS["cells first"])
    assert read_mesh_file(tmp_path / "a.vtk").notes == ("Maps of cells are passed over: c.",)
    (tmp_path / "a.vtk").write_text(POINTS + POLYGONS + SECTIONS["text"])
    assert read_mesh_file(tmp_path / "a.vtk").notes == ()
    write_vtp(tmp_path / "a.vtp", MESH, {"depth": V[:, 2]})
    text = (tmp_path / "a.vtp").read_text()
    array = '<DataArray type="Float64" Name="c" NumberOfComponents="1" format="ascii">what is not looked at</DataArray>'
    (tmp_path / "a.vtp").write_text(text.replace("</PointData>", f"</PointData><CellData>{array}</CellData>"))
    found = read_mesh_file(tmp_path / "a.vtp")
    assert found.notes == ("Maps of cells are passed over: c.",) and list(found.scalars) == ["depth"]


@pytest.mark.parametrize("space", ["LPS", "RAS"])
def test_coordinates_that_point_left_and_back_are_named(tmp_path: Path, space: str) -> None:
    (tmp_path / "a.vtk").write_text((POINTS + POLYGONS).replace("\nx\n", f"\n3D Slicer output. SPACE={space}\n", 1))
    write_ply(tmp_path / "a.ply", MESH)
    data = (tmp_path / "a.ply").read_bytes()
    (tmp_path / "a.ply").write_bytes(
        data.replace(b"\nelement vertex", f"\ncomment SPACE={space}\nelement vertex".encode(), 1)
    )
    for name in ("a.vtk", "a.ply"):
        found = read_mesh_file(tmp_path / name)
        assert np.array_equal(found.vertices, V), "nothing is turned"
        assert [("SPACE=LPS" in note) for note in found.notes] == ([True] if space == "LPS" else [])
