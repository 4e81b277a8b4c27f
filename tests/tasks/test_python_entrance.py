"""The one entrance of surfaces, maps, masks and sources, from Python."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL = sx.shape("icosphere", levels=3).mesh
HEIGHT = BALL.vertices[:, 2]
NOISY = HEIGHT + 0.1 * np.random.default_rng(0).standard_normal(len(HEIGHT))


def test_a_mask_of_sources_is_a_set_of_vertices() -> None:
    cap = HEIGHT > 0.9
    assert np.array_equal(sx.geodesic(Surface(BALL), cap), sx.geodesic(Surface(BALL), np.flatnonzero(cap)))
    with pytest.raises(ValueError, match="at least one"):
        sx.geodesic(Surface(BALL), HEIGHT > 2)


def test_a_hidden_value_is_one_that_was_not_measured() -> None:
    hidden = np.ma.masked_array(np.where(HEIGHT > 0.8, 1e6, HEIGHT), HEIGHT > 0.8)
    assert np.array_equal(
        sx.smooth(Surface(BALL), hidden, 0.3).values,
        sx.smooth(Surface(BALL), np.where(HEIGHT > 0.8, np.nan, HEIGHT), 0.3).values,
        equal_nan=True,
    )


def test_a_mask_as_an_array_means_what_it_means_as_a_file(tmp_path: Path) -> None:
    mask = np.where(HEIGHT > 0, 1.0, np.nan)
    sx.write(tmp_path / "ball.ply", Surface(BALL))
    sx.write(tmp_path / "mask.npy", mask)
    for given in (mask, tmp_path / "mask.npy", HEIGHT > 0):
        inside = sx.read(tmp_path / "ball.ply", mask=given).mask
        assert inside is not None and np.array_equal(inside, HEIGHT > 0)
    with pytest.raises(ValueError, match="mask is an array of type"):
        sx.read(tmp_path / "ball.ply", mask=np.where(HEIGHT > 0, "1", "0"))


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        (BALL.vertices, BALL.faces + 0.7, "faces has the value"),
        (BALL.vertices, np.where(BALL.faces == 3, np.nan, BALL.faces), "faces has the value nan"),
        (BALL.vertices + 1j, BALL.faces, "vertices is an array of type complex128"),
        (BALL.vertices, BALL.faces > 2, "booleans"),
        (BALL.vertices, [[0, 1, 2], [3]], "no array of numbers"),
        (BALL.vertices * 1e110, BALL.faces, "change the unit"),
        (BALL.vertices * 1e-110, BALL.faces, "change the unit"),
        (np.zeros((0, 3)), np.zeros((0, 3)), "missing faces"),
    ],
)
def test_a_pair_that_is_no_surface_is_refused_by_name(vertices: object, faces: object, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        sx.mean_curvature((vertices, faces))


@pytest.mark.parametrize(
    "faces",
    [
        np.r_[BALL.faces, BALL.faces[:300]],
        np.r_[BALL.faces, [[0, 0, 1]]],
        np.r_[BALL.faces[:5][:, ::-1], BALL.faces[5:]],
    ],
    ids=["twice", "repeated index", "flipped"],
)
def test_a_surface_made_by_hand_is_judged_as_a_pair_is(faces: np.ndarray) -> None:
    for task in (sx.eigenpairs, sx.mean_curvature, lambda surface: sx.geodesic(surface, 0)):
        with pytest.raises(ValueError, match=r"sx\.repair"):
            task(Surface(TriangleMesh(BALL.vertices, faces)))
    repaired = sx.repair((BALL.vertices, faces))
    assert sx.check(repaired).ok and repaired.notes
    values = sx.eigenpairs(repaired, 4).values
    assert values == pytest.approx(sx.eigenpairs(Surface(BALL), 4).values, abs=1e-6)


def test_maps_labels_and_masks_follow_a_repair() -> None:
    broken = Surface(
        TriangleMesh(np.r_[BALL.vertices, [[5.0, 5.0, 5.0]]], np.r_[BALL.faces, [[0, 0, 1]]]),
        scalars={"height": np.r_[HEIGHT, 5.0]},
        mask=np.r_[HEIGHT > 0, True],
    )
    repaired = sx.repair(broken)
    assert np.array_equal(repaired.scalars["height"], repaired.mesh.vertices[:, 2])
    assert repaired.mask is not None and np.array_equal(repaired.mask, repaired.mesh.vertices[:, 2] > 0)


def test_vertices_without_faces_keep_their_numbers_and_get_nan(tmp_path: Path) -> None:
    vertices = np.r_[[[9.0, 9.0, 9.0]], BALL.vertices]
    loose = (vertices, BALL.faces + 1)
    curvature = sx.mean_curvature(loose)
    assert np.isnan(curvature[0]) and np.array_equal(curvature[1:], sx.mean_curvature(Surface(BALL)))
    clean = sx.denoise(loose, np.r_[np.nan, NOISY])
    assert np.isnan(clean.values[0]) and np.allclose(clean.values[1:], sx.denoise(Surface(BALL), NOISY).values)
    assert any("belong to no face" in note for note in sx.eigenpairs(loose, 3).notes)
    unknown = vertices.copy()
    unknown[0] = np.nan
    assert np.array_equal(sx.mean_curvature((unknown, BALL.faces + 1))[1:], curvature[1:])


def test_only_the_part_inside_the_mask_has_to_be_sound() -> None:
    broken = TriangleMesh(BALL.vertices, np.r_[BALL.faces, BALL.faces[:1]])
    away = np.ones(len(BALL.vertices), dtype=bool)
    away[BALL.faces[0]] = False
    assert sx.eigenpairs(Surface(broken, mask=away), 3).complete
    with pytest.raises(ValueError, match="duplicate faces"):
        sx.eigenpairs(Surface(broken, mask=~np.zeros(len(away), dtype=bool)), 3)


def test_the_other_hemisphere_is_refused(tmp_path: Path) -> None:
    sx.write(tmp_path / "lh.ball.ply", Surface(BALL))
    sx.write(tmp_path / "rh.sulc.npy", HEIGHT)
    sx.write(tmp_path / "right.shape.gii", HEIGHT, Surface(BALL, hemisphere="right"))
    sx.write(tmp_path / "lh.sulc.npy", HEIGHT)
    surface = tmp_path / "lh.ball.ply"
    assert sx.read(surface, maps={"sulc": tmp_path / "lh.sulc.npy"}).hemisphere == "left"
    for file in ("rh.sulc.npy", "right.shape.gii"):
        with pytest.raises(ValueError, match="right hemisphere"):
            sx.read(surface, maps={"sulc": tmp_path / file})
        with pytest.raises(ValueError, match="right hemisphere"):
            sx.read(surface, mask=tmp_path / file)


@pytest.mark.parametrize("offset", [0.0, 1.0, 5e6, -1e9])
@pytest.mark.parametrize("factor", [1e-165, 1e-6, 1.0, 1e6, 1e150])
def test_neither_a_constant_nor_a_unit_changes_what_is_denoised(offset: float, factor: float) -> None:
    if offset:
        factor = abs(offset) * 1e-3
    plain = sx.denoise(Surface(BALL), NOISY)
    moved = sx.denoise(Surface(BALL), factor * NOISY + offset)
    assert (moved.values - offset) / factor == pytest.approx(plain.values, abs=1e-6)
    assert moved.certificate["relative_gap"] == pytest.approx(plain.certificate["relative_gap"], rel=1e-3)
    assert moved.certificate["noise"] / factor == pytest.approx(plain.certificate["noise"], rel=1e-6)
    assert moved.certificate["error_bound"] / factor == pytest.approx(plain.certificate["error_bound"], rel=1e-3)


@pytest.mark.parametrize("code", [float(np.finfo(np.float32).max), -9999.0, 1e200])
def test_a_code_for_nothing_measured_is_named(code: float) -> None:
    coded = NOISY.copy()
    coded[[7, 30]] = code
    for task in (sx.denoise, sx.segment, lambda surface, values: sx.smooth(surface, values, 0.5)):
        with pytest.raises(ValueError, match=r"2 of 642 values far from all others"):
            task(Surface(BALL), coded)
        task(Surface(BALL), np.where(coded == code, np.nan, coded))


def test_a_constant_map_has_no_noise() -> None:
    with pytest.raises(ValueError, match="constant"):
        sx.denoise(Surface(BALL), np.ones(len(HEIGHT)))


def test_a_surface_has_its_arrays_as_meshes_of_others_do() -> None:
    ball = sx.shape("icosphere", levels=2)
    assert ball.vertices is ball.mesh.vertices and ball.faces is ball.mesh.faces


def test_a_surface_by_hand_takes_arrays_as_functions_do() -> None:
    made = Surface((BALL.vertices, BALL.faces), scalars={"height": HEIGHT})
    assert np.array_equal(made.mesh.vertices, BALL.vertices) and np.array_equal(made.mesh.faces, BALL.faces)
    with pytest.raises(ValueError, match=r"^mesh is a ndarray, a TriangleMesh or \(vertices, faces\) is needed$"):
        Surface(BALL.vertices, BALL.faces)  # type: ignore[arg-type]


@pytest.mark.parametrize("target", ["a.ply", "a.vtk", "a.npz", "a.csv"])
def test_no_argument_of_write_is_passed_over(working_folder: Path, target: str) -> None:
    with pytest.raises(ValueError, match=r"^surface is a dict: give write"):
        sx.write(target, Surface(BALL), {"height": HEIGHT})  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"^surface is a ndarray: give write"):
        sx.write(target, BALL, HEIGHT)
    with pytest.raises(ValueError, match=r"^two surfaces are given"):
        sx.write(target, Surface(BALL), Surface(BALL))
    assert not Path(target).exists()


def test_a_map_is_written_beside_a_mesh_of_any_kind(working_folder: Path) -> None:
    for number, mesh in enumerate([BALL, (BALL.vertices, BALL.faces), Surface(BALL)]):
        sx.write(f"{number}.ply", {"height": HEIGHT}, mesh)
        assert np.array_equal(sx.read(f"{number}.ply").scalars["height"], HEIGHT)


@pytest.mark.parametrize("given", [Surface(BALL), [Surface(BALL)], [BALL]])
def test_fingerprints_are_of_files(given: object) -> None:
    with pytest.raises(ValueError, match=r"^sources hold a \w+, paths are needed; of surfaces in memory take sx\.\w+"):
        sx.fingerprint(given)  # type: ignore[arg-type]


def test_a_map_is_given_by_its_file(tmp_path: Path) -> None:
    """As on the command line, in every function that takes maps; a map that the surface carries comes first."""
    ball = sx.shape("icosphere", levels=2)
    height, noise = ball.vertices[:, 2], np.random.default_rng(0).standard_normal((162, 6))
    left = replace(ball, hemisphere="left")
    sx.write(tmp_path / "lh.height.shape.gii", height, left)
    height = height.astype(np.float32).astype(float)  # as GIFTI holds it
    sx.write(tmp_path / "lh.parts.label.gii", LabelMap((height > 0).astype(int), {0: "south", 1: "north"}), left)
    for file in (tmp_path / "lh.height.shape.gii", str(tmp_path / "lh.height.shape.gii")):
        smoothed = sx.smooth(left, file, 0.5)
        np.testing.assert_array_equal(smoothed.values, sx.smooth(left, height, 0.5).values)
        assert smoothed.name == "lh.height"
        np.testing.assert_array_equal(
            sx.plot(left, file, width=200).figure.pixels,
            sx.plot(left, height, width=200, label="lh.height").figure.pixels,
        )
    parts = sx.plot(left, tmp_path / "lh.parts.label.gii", width=200).figure.pixels
    table = LabelMap((height > 0).astype(int), {0: "south", 1: "north"})
    np.testing.assert_array_equal(parts, sx.plot(left, table, width=200).figure.pixels)
    files = []
    for k, column in enumerate(noise.T):
        files.append(tmp_path / f"s{k}.npy")
        sx.write(files[-1], column)
    found = sx.permutation_test(left, files, count=50)
    np.testing.assert_array_equal(found.t, sx.permutation_test(left, noise, count=50).t)
    with pytest.raises(ValueError, match="is of the left hemisphere, the surface of the right"):
        sx.smooth(replace(ball, hemisphere="right"), tmp_path / "lh.height.shape.gii", 0.5)
    with pytest.raises(ValueError, match="has no map 'hight'; it has none; give a name, a file or numbers"):
        sx.smooth(left, "hight", 0.5)
    carried = replace(left, scalars={str(files[0]): height})
    np.testing.assert_array_equal(sx.smooth(carried, str(files[0]), 0.5).values, smoothed.values)
