"""Round trips of every format, and files that are cut off, empty or garbage."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from surfexp.io import open3d_files
from surfexp.io.map_files import read_scalars
from surfexp.io.point_cloud import read_points
from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.welding import weld

MESH = TriangleMesh(
    icosphere(1).mesh.vertices + 0.1 * np.random.default_rng(0).random((42, 3)), icosphere(1).mesh.faces
)
HEIGHT = MESH.vertices[:, 2].copy()


def stl_bytes(binary: bool) -> bytes:
    corners = MESH.vertices[MESH.faces].astype(np.float32)
    if binary:
        records = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
        records["corners"] = corners
        return b" " * 80 + len(corners).to_bytes(4, "little") + records.tobytes()
    lines = ["solid ball"]
    for triangle in corners.tolist():
        lines += ["facet normal 0 0 0", "outer loop", *("vertex " + " ".join(map(repr, p)) for p in triangle)]
        lines += ["endloop", "endfacet"]
    return ("\n".join([*lines, "endsolid ball"]) + "\n").encode()


def ply_text(order: str) -> bytes:
    head = f"ply\nformat {order} 1.0\ncomment made by hand\nelement vertex 42\nproperty float x\nproperty float y\n"
    head += "property float z\nproperty uchar red\nelement face 80\nproperty list uchar int vertex_index\nend_header\n"
    if order == "ascii":
        body = "".join(f"{x!r} {y!r} {z!r} 7\n" for x, y, z in MESH.vertices.tolist())
        return (head + body + "".join(f"3 {a} {b} {c}\n" for a, b, c in MESH.faces.tolist())).encode()
    sign = "<" if "little" in order else ">"
    points = np.zeros(42, dtype=[("p", f"{sign}f4", 3), ("red", "u1")])
    points["p"], points["red"] = MESH.vertices, 7
    faces = np.zeros(80, dtype=[("n", "u1"), ("v", f"{sign}i4", 3)])
    faces["n"], faces["v"] = 3, MESH.faces
    return head.encode() + points.tobytes() + faces.tobytes()


def write_any(folder: Path, kind: str) -> tuple[Path, float]:
    """Write MESH in a format; the path and the precision that the format keeps."""
    path = folder / f"ball{kind}"
    if kind in (".off", ".obj", ".ply"):
        write_mesh(path, MESH)
        return path, 0.0
    if kind == ".gii":
        write_mesh(path, MESH)
    elif kind in ("-ascii.stl", "-binary.stl"):
        path.write_bytes(stl_bytes("binary" in kind))
    elif kind == ".vert":
        np.savetxt(path, MESH.vertices)
        np.savetxt(path.with_suffix(".tri"), MESH.faces + 1, fmt="%d")
    elif kind == ".pial":
        from nibabel.freesurfer import write_geometry

        write_geometry(path, MESH.vertices, MESH.faces)
    else:
        path = folder / "ball.ply"
        path.write_bytes(ply_text(kind))
    return path, 1e-6


KINDS = [".off", ".obj", ".ply", ".gii", "-ascii.stl", "-binary.stl", ".vert", ".pial"]
KINDS += ["ascii", "binary_little_endian", "binary_big_endian"]


@pytest.mark.parametrize("kind", KINDS)
def test_round_trip(tmp_path: Path, kind: str) -> None:
    path, precision = write_any(tmp_path, kind)
    vertices, faces, scalars = read_mesh(path)
    if "stl" in kind:
        assert len(vertices) == 42
        assert vertices[faces] == pytest.approx(MESH.vertices[MESH.faces], abs=precision)
        return
    assert (faces == MESH.faces).all()
    assert np.abs(vertices - MESH.vertices).max() <= precision
    assert vertices.dtype == np.float64 and faces.dtype == np.int64
    if kind in ("ascii", "binary_little_endian", "binary_big_endian"):
        assert (scalars["red"] == 7).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("share", [0.05, 0.3, 0.5, 0.8, 0.97])
def test_truncated_file_is_refused_with_its_name(tmp_path: Path, kind: str, share: float) -> None:
    path, _ = write_any(tmp_path, kind)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    if kind == ".obj":
        # no count stands in an OBJ file: faces can be missing at its end without a trace, corners cannot
        try:
            vertices, faces, _ = read_mesh(path)
        except ValueError as error:
            assert str(path) in str(error) and "\n" not in str(error)
        else:
            assert share > 0.5 and len(vertices) == 42 and len(faces) < 80
        return
    with pytest.raises(ValueError, match=path.name) as caught:
        vertices, faces, _ = read_mesh(path)
        # a text table cut between two rows is complete in itself
        assert kind != ".vert" or faces.max() < len(vertices)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("suffix", [".off", ".obj", ".ply", ".stl", ".gii", ".vert", ".pial", ".gii.gz"])
@pytest.mark.parametrize("content", [b"", b"\x00" * 200, bytes(range(256)) * 4, b"OFF\n", b"ply\n", b"hello world\n"])
def test_garbage_is_refused_with_its_name(tmp_path: Path, suffix: str, content: bytes) -> None:
    path = tmp_path / f"junk{suffix}"
    path.write_bytes(content)
    with pytest.raises(ValueError, match="junk") as caught:
        read_mesh(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "names vertex 7"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "cut short"),
        ("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "4 of 3 vertices and 2 faces"),
        ("a.off", "OFF\n3 1 0\n0 0 x\n1 0 0\n0 1 0\n3 0 1 2\n", "x"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "line 4"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "names vertex 8"),
        ("a.obj", "v 0 0 0\n", "1 points without faces"),
        ("a.obj", "v 0 0 0\nblah\n", "1 points without faces"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
            "point_cloud",
        ),
        ("a.tri", "1 2 3\n", "a.vert beside it is missing"),
        ("a.xyz", "1 2 3\n", "point_cloud"),
        ("a.doc", "1 2 3\n", "format is unknown"),
    ],
)
def test_reason_is_named(tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=words):
        read_mesh(tmp_path / name)


def test_missing_file_is_named(tmp_path: Path) -> None:
    for suffix in (".off", ".ply", ".gii", ".pial"):
        with pytest.raises(ValueError, match=f"nowhere{suffix} cannot be read as a mesh: no such file"):
            read_mesh(tmp_path / f"nowhere{suffix}")


def test_polygons_slashes_negative_indices_and_comments(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(
        "# comment\nmtllib x\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1/1 3//1 4\nf -4 -3 \\\n-2\n"
    )
    assert read_mesh(tmp_path / "a.obj")[1].tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 2]]
    (tmp_path / "a.off").write_text(
        "COFF 4 1 0 # counts\n0 0 0 1 1 1\n1 0 0 1 1 1\n\n1 1 0 1 1 1\n0 1 0 1 1 1\n4 0 1 2 3\n"
    )
    assert read_mesh(tmp_path / "a.off")[1].tolist() == [[0, 1, 2], [0, 2, 3]]
    head = b"ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
    head += b"element face 2\nproperty list uchar int vertex_indices\nproperty uchar flag\nend_header\n"
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype="<f8").tobytes()
    mixed = (
        b"\x03" + np.array([0, 1, 2], "<i4").tobytes() + b"\x09\x04" + np.array([0, 1, 2, 3], "<i4").tobytes() + b"\x09"
    )
    (tmp_path / "a.ply").write_bytes(head + points + mixed)
    assert read_mesh(tmp_path / "a.ply")[1].tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3]]


def test_scalars_travel_with_ply_and_vtk(tmp_path: Path) -> None:
    write_mesh(tmp_path / "a.ply", MESH, {"sulcal depth": HEIGHT})
    scalars = read_mesh(tmp_path / "a.ply")[2]
    assert (scalars["sulcal_depth"] == HEIGHT).all()
    write_mesh(tmp_path / "a.vtk", MESH, {"height": HEIGHT})
    words = (tmp_path / "a.vtk").read_text().split()
    assert np.array(words[words.index("default") + 1 :], dtype=float).tolist() == HEIGHT.tolist()
    start = words.index("POLYGONS") + 3
    assert np.array(words[start : start + 320], dtype=int).reshape(-1, 4)[:, 1:].tolist() == MESH.faces.tolist()


def test_a_vtk_file_with_more_numbers_than_it_announces_is_refused(tmp_path: Path) -> None:
    head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0%s\n"
    for more in ("", " 7"):
        (tmp_path / "a.vtk").write_text(head % more + "POLYGONS 1 4\n3 0 1 2\n")
        if more:
            with pytest.raises(ValueError, match="it has 10 numbers where 9 are announced"):
                read_mesh(tmp_path / "a.vtk")
        else:
            assert read_mesh(tmp_path / "a.vtk")[1].tolist() == [[0, 1, 2]]


def test_writer_refuses_what_it_cannot_do(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"cannot carry scalar maps \(h\), choose one of \.ply, \.vtk"):
        write_mesh(tmp_path / "a.off", MESH, {"h": HEIGHT})
    with pytest.raises(ValueError, match="unknown format"):
        write_mesh(tmp_path / "a.doc", MESH)
    with pytest.raises(ValueError, match="has 3 values, the mesh has 42"):
        write_mesh(tmp_path / "a.ply", MESH, {"h": HEIGHT[:3]})
    assert not list(tmp_path.iterdir())


def test_scalar_maps_of_every_format(tmp_path: Path) -> None:
    import nibabel
    from nibabel.freesurfer import write_morph_data

    np.save(tmp_path / "a.npy", HEIGHT)
    np.savetxt(tmp_path / "a.txt", HEIGHT)
    np.savetxt(tmp_path / "a.csv", HEIGHT, delimiter=",")
    write_morph_data(tmp_path / "lh.sulc", HEIGHT)
    array = nibabel.gifti.GiftiDataArray(HEIGHT.astype(np.float32), "NIFTI_INTENT_SHAPE")
    nibabel.save(nibabel.gifti.GiftiImage(darrays=[array]), tmp_path / "a.shape.gii")
    for name in ("a.npy", "a.txt", "a.csv", "lh.sulc", "a.shape.gii"):
        assert read_scalars(tmp_path / name) == pytest.approx(HEIGHT, abs=1e-6), name
        data = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(data[: len(data) // 2] + (b"x" if name.endswith(("txt", "csv")) else b""))
        with pytest.raises(ValueError, match=name):
            read_scalars(tmp_path / name)
    with pytest.raises(ValueError, match="holds no surface"):
        nibabel.save(nibabel.gifti.GiftiImage(darrays=[array]), tmp_path / "b.gii")
        read_mesh(tmp_path / "b.gii")
    with pytest.raises(ValueError, match="nowhere"):
        read_scalars(tmp_path / "nowhere.npy")


def test_pickles_are_not_read(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(ValueError, match=r"a\.npy"):
        read_scalars(tmp_path / "a.npy")


def test_weld_numbers_vertices_as_they_appear() -> None:
    vertices, faces = weld(MESH.vertices[MESH.faces])
    assert (vertices[faces] == MESH.vertices[MESH.faces]).all()
    assert len(vertices) == 42 and faces[0].tolist() == [0, 1, 2]


def test_missing_open3d_names_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.glb").write_bytes(b"glTF")
    monkeypatch.setitem(__import__("sys").modules, "open3d", None)
    with pytest.raises(ValueError, match=r"a\.glb .*pip install 'surfexp\[open3d\]'"):
        read_mesh(tmp_path / "a.glb")
    reason = open3d_files.missing_part(ImportError("libusb-1.0.so.0: cannot open shared object file"))
    assert "apt-get install libusb-1.0-0" in reason


def test_point_files(tmp_path: Path) -> None:
    (tmp_path / "a.xyz").write_text("0 0 1 9 9 9\n1 2 3 9 9 9\n")
    assert read_points(tmp_path / "a.xyz").tolist() == [[0, 0, 1], [1, 2, 3]]
    (tmp_path / "b.xyz").write_text("0 0\n")
    with pytest.raises(ValueError, match=r"b\.xyz"):
        read_points(tmp_path / "b.xyz")


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_triangle_strips_of_ply_have_one_orientation(tmp_path: Path, order: str) -> None:
    rows, columns = 4, 6
    vertices = np.array([[j, i, 0.0] for i in range(rows) for j in range(columns)], dtype=np.float64)
    strip: list[int] = []
    for i in range(rows - 1):
        # the last row turns a corner by a repeated vertex instead of beginning a new strip
        joint = [-1] if i < rows - 2 else [strip[-1], i * columns]
        strip += (joint if strip else []) + [
            k for j in range(columns) for k in (i * columns + j, (i + 1) * columns + j)
        ]
    head = f"ply\nformat {order} 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
    head += "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    if order == "ascii":
        lines = [" ".join(map(repr, row)) for row in vertices.tolist()] + [f"{len(strip)} {' '.join(map(str, strip))}"]
        data = "\n".join(lines).encode()
    else:
        kind = "<" if "little" in order else ">"
        data = vertices.astype(f"{kind}f8").tobytes() + np.array([len(strip), *strip], f"{kind}i4").tobytes()
    (tmp_path / "strips.ply").write_bytes(head.encode() + data)
    read_vertices, faces, _ = read_mesh(tmp_path / "strips.ply")
    assert (read_vertices == vertices).all() and len(faces) == 2 * (rows - 1) * (columns - 1)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    doubled = np.cross(b - a, c - a)[:, 2]
    assert (np.abs(doubled) == 1).all() and len(set(np.sign(doubled))) == 1
    assert np.abs(doubled).sum() / 2 == (rows - 1) * (columns - 1)
