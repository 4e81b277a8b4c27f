"""Files that name the vertex beside each value, and names of labels that mean no cortex."""

from __future__ import annotations

from pathlib import Path

import nibabel
import numpy as np
import pytest
from nibabel.freesurfer import write_annot

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.figures.labelling import labelling
from surfexp.io.map_files import mask_notes, read_maps, read_mask, read_named_labels
from surfexp.io.medial_wall import is_outside
from surfexp.io.reading import read_mesh
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

MESH = icosphere(1).mesh
N, M = len(MESH.vertices), len(MESH.faces)
HEIGHT = MESH.vertices[:, 2].copy()
UPPER = HEIGHT > 0.1
COLORS = np.array([[10, 20, 30, 0], [200, 100, 50, 0]], np.int32)
OUTSIDE = [
    *(
        "unknown",
        "Unknown",
        "lh.unknown",
        "ctx-lh-unknown",
        "???",
        "L_???",
        "Medial_wall",
        "lh_Medial_wall",
        "MEDIAL.WALL",
    ),
    *(
        "Background+FreeSurfer_Defined_Medial_Wall",
        "FreeSurfer_Defined_Medial_Wall",
        "corpuscallosum",
        "L_corpuscallosum",
    ),
    *("none", "Background", "medialwall", "medial wall", "unassigned", "unknown_lh"),
]
INSIDE = ["insula", "medialorbitofrontal", "L_V1_ROI", "G_front_sup", "lh", "wall", "7Networks_LH_Vis_1", "S_callosal"]


@pytest.mark.parametrize("name", OUTSIDE)
def test_names_of_the_medial_wall_are_outside(name: str) -> None:
    assert is_outside(name)


@pytest.mark.parametrize("name", INSIDE)
def test_names_of_regions_are_inside(name: str) -> None:
    assert not is_outside(name)


def test_a_mask_of_labels_leaves_out_the_medial_wall_and_says_so(tmp_path: Path) -> None:
    table = nibabel.gifti.GiftiLabelTable()
    for key, name in enumerate(["Background+FreeSurfer_Defined_Medial_Wall", "A1"]):
        entry = nibabel.gifti.GiftiLabel(key, 1.0, 0.0, 0.0, 1.0)
        entry.label = name
        table.labels.append(entry)
    keys = UPPER.astype(np.int32)[:, None]
    array = nibabel.gifti.GiftiDataArray(keys, "NIFTI_INTENT_LABEL")
    nibabel.save(nibabel.gifti.GiftiImage(labeltable=table, darrays=[array]), tmp_path / "a.label.gii")
    assert np.array_equal(read_mask(tmp_path / "a.label.gii", N), UPPER)
    sx.write(tmp_path / "a.off", sx.Surface(MESH))
    said = sx.read(tmp_path / "a.off", mask=tmp_path / "a.label.gii").notes
    assert said == mask_notes(tmp_path / "a.label.gii") and "FreeSurfer_Defined_Medial_Wall" in said[0]


def annotation(path: Path, order: np.ndarray, strange: np.ndarray) -> None:
    """Write labels by nibabel, then reorder its pairs of vertex and colour, and give some a colour of no entry."""
    write_annot(path, UPPER.astype(np.int32), COLORS, [b"other", b"A1"], fill_ctab=True)
    data = path.read_bytes()
    pairs = np.frombuffer(data, ">i4", 2 * N, 4).reshape(N, 2).copy()
    pairs[strange, 1] = 12345
    path.write_bytes(data[:4] + pairs[order].tobytes() + data[4 + 8 * N :])


def test_an_annotation_is_read_by_its_vertices_and_colours(tmp_path: Path) -> None:
    order = np.random.default_rng(0).permutation(N)
    strange = np.flatnonzero(UPPER)[:7]
    annotation(tmp_path / "lh.a.annot", order, strange)
    found = read_named_labels(tmp_path / "lh.a.annot")
    expected = UPPER.astype(int)
    expected[strange] = -1
    assert np.array_equal(found.keys, expected)
    assert "7 vertices" in mask_notes(tmp_path / "lh.a.annot")[0]
    annotation(tmp_path / "lh.a.annot", np.zeros(N, int), strange)
    with pytest.raises(ValueError, match=r"do not name the vertices 0\.\.41 once each"):
        read_named_labels(tmp_path / "lh.a.annot")


def test_values_of_a_gifti_file_go_to_the_nodes_that_it_lists(tmp_path: Path) -> None:
    order = np.random.default_rng(0).permutation(N)

    def save(nodes: np.ndarray) -> None:
        index = nibabel.gifti.GiftiDataArray(nodes.astype(np.int32), "NIFTI_INTENT_NODE_INDEX")
        values = nibabel.gifti.GiftiDataArray(HEIGHT[order].astype(np.float32), "NIFTI_INTENT_NONE")
        nibabel.save(nibabel.gifti.GiftiImage(darrays=[index, values]), tmp_path / "a.func.gii")

    save(order)
    assert read_maps(tmp_path / "a.func.gii")["a"] == pytest.approx(HEIGHT, abs=1e-7)
    save(order + 1)
    found = read_maps(tmp_path / "a.func.gii")["a"]
    assert np.isnan(found[0]) and found[1:] == pytest.approx(HEIGHT, abs=1e-7)
    for nodes, words in (
        (np.zeros(N, int), "node indices"),
        (order - 1, "node indices"),
        (order + (1 << 30), "largest"),
    ):
        save(nodes)
        with pytest.raises(ValueError, match=words):
            read_maps(tmp_path / "a.func.gii")


def test_older_and_other_files_of_freesurfer(tmp_path: Path) -> None:
    old = N.to_bytes(3, "big") + M.to_bytes(3, "big") + np.round(100 * HEIGHT).astype(">i2").tobytes()
    (tmp_path / "lh.curv").write_bytes(old)
    assert next(iter(read_maps(tmp_path / "lh.curv").values())) == pytest.approx(HEIGHT, abs=0.005)
    rows = [f"{x!r} {y!r} {z!r} 0" for x, y, z in MESH.vertices.tolist()] + [f"{a} {b} {c} 0" for a, b, c in MESH.faces]
    (tmp_path / "lh.white.asc").write_text("\n".join(["#!ascii version of lh.white", f"{N} {M}", *rows]) + "\n")
    vertices, faces, _ = read_mesh(tmp_path / "lh.white.asc")
    assert np.array_equal(vertices, MESH.vertices) and np.array_equal(faces, MESH.faces)
    (tmp_path / "lh.curv.asc").write_text("".join(f"{k:03d} 0 0 0 {z!r}\n" for k, z in enumerate(HEIGHT.tolist())))
    assert np.array_equal(read_maps(tmp_path / "lh.curv.asc")["lh.curv"], HEIGHT)
    (tmp_path / "lh.a.label").write_text("#!ascii\n3\n-1 0 0 0 0\n4 0 0 0 0\n7 0 0 0 0\n")
    assert np.flatnonzero(read_mask(tmp_path / "lh.a.label", N)).tolist() == [4, 7]


@pytest.mark.parametrize("ends", [b"\n", b"\n\n"])
def test_the_stamp_of_a_surface_ends_with_one_or_two_lines(tmp_path: Path, ends: bytes) -> None:
    counts = np.array([N, M], ">i4").tobytes()
    body = MESH.vertices.astype(">f4").tobytes() + MESH.faces.astype(">i4").tobytes()
    (tmp_path / "lh.white").write_bytes(b"\xff\xff\xfecreated by me" + ends + counts + body)
    vertices, faces, _ = read_mesh(tmp_path / "lh.white")
    assert np.array_equal(vertices, MESH.vertices.astype(np.float32)) and np.array_equal(faces, MESH.faces)


@pytest.mark.parametrize("shape", [(N, 1, 1), (1, 1, N), (1, N, 1), (7, 1, 6)])
def test_maps_in_volumes_of_one_row(tmp_path: Path, shape: tuple[int, int, int]) -> None:
    data = HEIGHT.astype(np.float32).reshape(shape, order="F")
    nibabel.save(nibabel.Nifti1Image(data, np.eye(4)), tmp_path / "a.nii.gz")
    assert read_maps(tmp_path / "a.nii.gz")["a"] == pytest.approx(HEIGHT, abs=1e-7)
    nibabel.save(nibabel.freesurfer.MGHImage(data, np.eye(4)), tmp_path / "a.mgz")
    if 7 in shape:
        with pytest.raises(ValueError, match="mri_vol2surf"):
            read_maps(tmp_path / "a.mgz")
    else:
        assert read_maps(tmp_path / "a.mgz")["a"] == pytest.approx(HEIGHT, abs=1e-7)


def test_distances_on_two_components_are_written_and_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    vertices = np.concatenate([MESH.vertices, MESH.vertices + 5.0])
    sx.write(tmp_path / "two.off", sx.Surface(TriangleMesh(vertices, np.concatenate([MESH.faces, MESH.faces + N]))))
    target = tmp_path / "x.shape.gii"
    assert main(["geodesic", str(tmp_path / "two.off"), "0", "--to", str(target)]) == 0
    assert "42 vertices are joined to no source" in "".join(capsys.readouterr())
    distance = read_maps(target)["distance"]
    assert np.isfinite(distance[:N]).all() and np.isnan(distance[N:]).all()


def test_a_vertex_without_faces_keeps_the_numbering_under_repair(tmp_path: Path) -> None:
    points = np.concatenate([[[9.0, 9, 9]], MESH.vertices])
    sx.write(tmp_path / "a.off", sx.Surface(TriangleMesh(points, MESH.faces + 1), mask=np.arange(N + 1) > 0))
    np.savetxt(tmp_path / "a.txt", points[:, 2])
    surface = sx.read(tmp_path / "a.off", maps={"height": tmp_path / "a.txt"}, repair=True)
    assert len(surface.mesh.vertices) == N + 1
    smooth = np.asarray(sx.smooth(surface, "height", 0.3).values)
    assert np.isnan(smooth[0]) and np.isfinite(smooth[1:]).all()


def test_labels_that_have_numbers_only_are_a_mask_and_a_picture(tmp_path: Path) -> None:
    """Subfields of the hippocampus: the table names nothing but "???"."""
    keys = np.where(UPPER, 1 + np.arange(N) % 2, 0)
    table = nibabel.gifti.GiftiLabelTable()
    entry = nibabel.gifti.GiftiLabel(0, 1.0, 1.0, 1.0, 0.0)
    entry.label = "???"
    table.labels.append(entry)
    array = nibabel.gifti.GiftiDataArray(keys.astype(np.int32), "NIFTI_INTENT_LABEL")
    file = tmp_path / "a.label.gii"
    nibabel.save(nibabel.gifti.GiftiImage(labeltable=table, darrays=[array]), file)
    assert np.array_equal(read_mask(file, N), UPPER)
    assert np.array_equal(read_mask(f"{file}:2", N), keys == 2)
    assert mask_notes(file) == (
        "Outside the mask are the labels '???' of a.label.gii.",
        "a.label.gii names no label: inside are its labels 1, 2.",
    )
    with pytest.raises(ValueError, match="no label is named 'CA1', labels have numbers only: choose from 1, 2"):
        read_mask(f"{file}:CA1", N)
    assert labelling(keys, {0: "???"}).names == ("1", "2")


def test_a_number_chooses_a_label_beside_its_name(tmp_path: Path) -> None:
    sx.write(tmp_path / "a.label.gii", LabelMap(UPPER.astype(int), {0: "medial wall", 1: "A1"}))
    for chosen in ("1", "A1"):
        assert np.array_equal(read_mask(f"{tmp_path / 'a.label.gii'}:{chosen}", N), UPPER)
    assert labelling(UPPER.astype(int), {0: "Background+FreeSurfer_Defined_Medial_Wall", 1: "A1"}).names == ("A1",)
    with pytest.raises(ValueError, match="no label is named '7', the nearest of 2 is"):
        read_mask(f"{tmp_path / 'a.label.gii'}:7", N)
