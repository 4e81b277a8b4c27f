"""Results stand on the vertices of the file, whatever was repaired, cut away or masked on the way."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import nibabel
import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.io.map_files import read_maps
from surfexp.mesh.file_vertices import FileVertices, under_own_numbers
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.repair import repair
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL = sx.shape("icosphere", levels=2).mesh
V, F = BALL.vertices, BALL.faces
Arrays = tuple[np.ndarray, np.ndarray]


def loose() -> Arrays:
    return np.r_[[[9.0, 9.0, 9.0]], V], F + 1


def flipped() -> Arrays:
    faces = np.array(F)
    faces[:9] = faces[:9, ::-1]
    return loose()[0], faces + 1


def unknown() -> Arrays:
    vertices = np.array(V)
    vertices[[5, 60]] = np.nan
    return vertices, F


def cut_open() -> Arrays:
    """Two halves, of which each has the vertices between them."""
    upper = V[F].mean(axis=1)[:, 2] > 0
    both, numbers = np.unique(np.where(upper[:, None], F, F + len(V)), return_inverse=True)
    return np.r_[V, V][both], numbers.reshape(-1, 3)


def touching() -> Arrays:
    """Two balls with one vertex in common."""
    numbers = np.arange(len(V)) + len(V)
    far = int(np.linalg.norm(V + V[0], axis=1).argmin())
    numbers[far] = 0
    return np.r_[V, V + 2 * V[0]], np.r_[F, numbers[F]]


def doubled() -> Arrays:
    return V, np.r_[F, F[:5]]


KINDS: dict[str, Callable[[], Arrays]] = {
    made.__name__: made for made in (loose, flipped, unknown, cut_open, touching, doubled)
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_map_beside_a_defective_surface_is_answered_on_its_vertices(
    working_folder: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    vertices, faces = KINDS[kind]()
    sx.write("a.npz", (vertices, faces))
    values = np.nan_to_num(vertices[:, 2]) + 0.1 * np.random.default_rng(0).standard_normal(len(vertices))
    sx.write("m.txt", values)
    for arguments in (["smooth", "a.npz", "m.txt", "--width", ".5"], ["denoise", "a.npz", "m.txt", "--noise", ".1"]):
        assert main([*arguments, "--repair", "--to", "out.npy"]) == 0, capsys.readouterr().err
        found = np.load("out.npy")
        named = np.zeros(len(vertices), dtype=bool)
        named[faces] = True
        named &= np.isfinite(vertices).all(axis=1)
        assert np.array_equal(np.isfinite(found), named)
        assert np.abs(found - values)[named].max() < 1.0
    assert main(["modes", "a.npz", "-k", "4", "--repair", "--to", "modes.npz"]) == 0
    assert np.load("modes.npz")["vectors"].shape == (len(vertices), 4)


@pytest.mark.parametrize("kind", KINDS)
def test_maps_labels_and_masks_follow_and_come_back(working_folder: Path, kind: str) -> None:
    vertices, faces = KINDS[kind]()
    sx.write("a.npz", (vertices, faces))
    number = np.arange(len(vertices), dtype=float)
    sx.write("m.npy", number)
    surface = sx.read("a.npz", maps="m.npy", mask=number >= 0, repair=True)
    mended = sx.repair(surface)
    assert sx.check(mended).ok
    # vertices without position are outside as they are
    assert kind == "unknown" or np.array_equal(mended.mesh.faces, surface.mesh.faces)
    count = len(surface.mesh.vertices)
    assert np.array_equal(surface.scalars["m"][: len(vertices)], number) and surface.mask is not None
    moved = np.linalg.norm(surface.mesh.vertices - vertices[surface.scalars["m"].astype(int)], axis=1)
    assert not moved[np.isfinite(moved)].size or np.nanmax(moved) < 0.01
    assert (count > len(vertices)) == (kind == "touching")
    smooth = sx.smooth(surface, number, 0.5)
    assert len(smooth.values) == count
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for target in ("out.npy", "out.npz", "out.ply"):
            sx.write(target, smooth.values, surface)
    assert len(np.load("out.npy")) == len(vertices)
    assert len(sx.read("out.ply").mesh.vertices) == count


def test_what_is_repaired_keeps_its_numbers_unless_it_is_asked_to_renumber(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    vertices, faces = flipped()
    sx.write("a.off", (vertices, faces))
    sx.write("m.txt", vertices[:, 2])
    assert main(["repair", "a.off", "--to", "b.off"]) == 0
    assert main(["check", "b.off"]) == 0 and "note: 1 unreferenced vertices" in capsys.readouterr().out
    assert np.array_equal(sx.read("b.off", maps="m.txt").mesh.vertices, vertices)
    assert main(["repair", "a.off", "--renumber", "--to", "c.off"]) == 0
    assert np.array_equal(sx.read("c.off").mesh.vertices, V)
    assert len(sx.repair((vertices, faces), renumber=True).mesh.vertices) == len(V)


def test_a_merged_vertex_has_the_value_of_the_one_it_became(working_folder: Path) -> None:
    vertices, faces = cut_open()
    mesh, file = under_own_numbers(vertices, faces, repair(vertices, faces))
    assert mesh.is_closed and len(mesh.vertices) == len(vertices)
    assert np.array_equal(vertices[file.standing], vertices) and len(np.unique(file.standing)) == len(V)
    assert np.array_equal(file.onto_file(file.onto_mesh(vertices)), vertices)


def test_two_repairs_are_one() -> None:
    first, second = (
        FileVertices(np.array([0, 1, 2, 1]), np.array([0, 1, 1])),
        FileVertices(np.array([0, 1, 2, 3, 3]), np.array([0, 1, 2, 3])),
    )
    both = first.then(second)
    assert both.origin.tolist() == [0, 1, 2, 1, 1] and both.standing.tolist() == [0, 1, 1]


def test_sources_are_vertices_of_the_file() -> None:
    vertices, faces = cut_open()
    surface = sx.repair((vertices, faces))
    assert surface.file is not None
    merged = int(np.flatnonzero(surface.file.standing != np.arange(len(vertices)))[0])
    kept = int(surface.file.standing[merged])
    assert np.array_equal(sx.geodesic(surface, merged), sx.geodesic(surface, kept), equal_nan=True)


@pytest.mark.parametrize("outside", ["flipped", "unknown", "loose", "doubled"])
def test_only_the_part_inside_a_mask_has_to_be_sound(
    working_folder: Path, outside: str, capsys: pytest.CaptureFixture[str]
) -> None:
    vertices, faces = KINDS[outside]()
    height = np.nan_to_num(vertices[:, 2], nan=-9.0)
    broken = {"flipped": faces[:9], "doubled": faces[:5]}.get(outside, np.zeros((0, 3), dtype=int))
    mask = np.isfinite(vertices).all(axis=1) & (height < 5)
    mask[broken] = False
    sx.write("a.npz", (vertices, faces))
    sx.write("mask.txt", mask.astype(float))
    sx.write("m.txt", height)
    assert main(["smooth", "a.npz", "m.txt", "--width", ".5", "--mask", "mask.txt", "--to", "out.npy"]) == 0
    found = np.load("out.npy")
    assert len(found) == len(vertices) and not np.isfinite(found[~mask]).any() and np.isfinite(found).sum() > 100
    assert "repaired" not in capsys.readouterr().err


def test_vertices_without_position_are_cut_away_with_a_note(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sx.write("a.npz", unknown())
    assert main(["modes", "a.npz", "-k", "4", "--to", "m.npz"]) == 0
    assert (
        "2 of 162 vertices belong to no face or have no finite position: they are outside." in capsys.readouterr().err
    )
    lost = np.isnan(np.load("m.npz")["vectors"]).any(axis=1)
    assert np.flatnonzero(lost).tolist() == [5, 60]


def test_a_flat_patch_and_a_map_of_the_whole_sphere(working_folder: Path) -> None:
    """As cortical flat patches come: the cut has no faces, and a map has a value at every vertex."""
    kept = V[F].mean(axis=1)[:, 2] > -0.5
    gifti = nibabel.gifti
    arrays = [
        gifti.GiftiDataArray((V * [1, 1, 0]).astype(np.float32) + 0.1 * V.astype(np.float32), "NIFTI_INTENT_POINTSET"),
        gifti.GiftiDataArray(F[kept].astype(np.int32), "NIFTI_INTENT_TRIANGLE"),
    ]
    nibabel.save(gifti.GiftiImage(darrays=arrays), "flat.gii.gz")
    sx.write("sulc.shape.gii", V[:, 0])
    for repair_flag in ([], ["--repair"]):
        assert (
            main(["smooth", "flat.gii.gz", "sulc.shape.gii", "--width", ".5", *repair_flag, "--to", "o.shape.gii"]) == 0
        )
        found = next(iter(read_maps("o.shape.gii").values()))
        assert np.array_equal(np.isnan(found), ~np.isin(np.arange(len(V)), F[kept]))


def test_a_mesh_with_no_face_at_finite_vertices_has_no_way_out() -> None:
    with pytest.raises(ValueError, match="no repair is possible"):
        sx.smooth((np.full((3, 3), np.nan), [[0, 1, 2]]), np.ones(3), 1.0)
    assert TriangleMesh(V, F).is_closed


def test_labels_of_the_file_fit_its_repaired_surface(tmp_path: Path) -> None:
    """Pictures, borders and tables of clusters take labels on the vertices of the file, though repair split some."""
    vertices, faces = touching()
    sx.write(tmp_path / "a.npz", {"vertices": vertices, "faces": faces})
    surface = sx.repair((vertices, faces))
    assert len(surface.vertices) > len(vertices)
    keys = (vertices[:, 2] > 0).astype(np.int64)
    drawn = sx.plot(surface, LabelMap(keys, {0: "south", 1: "north"}), width=200).figure.pixels
    copies = np.r_[keys, keys[surface.file.origin[len(keys) :]]]
    np.testing.assert_array_equal(
        drawn, sx.plot(surface, LabelMap(copies, {0: "south", 1: "north"}), width=200).figure.pixels
    )
    maps = np.random.default_rng(0).standard_normal((len(vertices), 6)) + 5.0
    found = sx.permutation_test(surface, maps, labels=LabelMap(keys, {0: "south", 1: "north"}))
    assert {name for one in found.clusters for name in one.parcels} == {"south", "north"}
    with pytest.raises(ValueError, match=r"labels have shape \(7,\), the surface has"):
        sx.plot(surface, LabelMap(keys[:7], {0: "south", 1: "north"}))
