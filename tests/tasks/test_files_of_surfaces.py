"""What `sx.read` is given as files of maps, and what `sx.write` keeps of a surface."""

from __future__ import annotations

import warnings
from pathlib import Path
from types import SimpleNamespace

import nibabel
import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.io.hemisphere import hemisphere_of_file
from surfexp.io.label_files import read_label_map
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.spatial_frame import CoordinateTransform, SpatialFrame

BALL = sx.shape("icosphere", levels=2).mesh
V, F = BALL.vertices, BALL.faces
HEIGHT = V[:, 2]
COUNT = len(V)


@pytest.fixture
def folder(working_folder: Path) -> Path:
    sx.write("ball.ply", BALL)
    sx.write("lh.thickness.csv", HEIGHT)
    sx.write("sulc.npy", 2 * HEIGHT)
    sx.write("two.csv", {"a": HEIGHT, "b": 3 * HEIGHT})
    return working_folder


@pytest.mark.parametrize("as_path", [str, Path])
def test_maps_are_called_as_their_files(folder: Path, as_path: type) -> None:
    one = sx.read("ball.ply", maps=as_path("sulc.npy"))
    assert list(one.scalars) == ["sulc"] and np.array_equal(one.scalars["sulc"], 2 * HEIGHT)
    several = sx.read("ball.ply", maps=[as_path("lh.thickness.csv"), as_path("sulc.npy"), as_path("two.csv")])
    assert list(several.scalars) == ["lh.thickness", "sulc", "two a", "two b"]
    assert np.array_equal(several.scalars["two b"], 3 * HEIGHT)


@pytest.mark.parametrize(
    ("maps", "says"),
    [
        (["sulc.npy", Path("sulc.npy")], "two files of maps are called 'sulc'"),
        ([HEIGHT], "maps has a ndarray"),
        (3, "maps has a int"),
        ({"a": 3}, "maps has a int"),
    ],
)
def test_maps_that_are_no_files_or_share_a_name_are_refused(folder: Path, maps: object, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        sx.read("ball.ply", maps=maps)  # type: ignore[arg-type]


@pytest.mark.parametrize("suffix", [".ply", ".off", ".npz", ".vtp"])
@pytest.mark.parametrize(
    "given", [BALL, (V, F), [V, F], SimpleNamespace(vertices=V, faces=F), SimpleNamespace(v=V, t=F)]
)
def test_a_mesh_of_any_kind_is_written(working_folder: Path, given: object, suffix: str) -> None:
    sx.write(f"ball{suffix}", given)
    again = sx.read(f"ball{suffix}").mesh
    assert np.array_equal(again.vertices, V) and np.array_equal(again.faces, F)


@pytest.mark.parametrize("side", ["left", "right", ""])
@pytest.mark.parametrize("name", ["ball.ply", "ball.npz", "ball.surf.gii"])
def test_surfaces_and_maps_beside_them_keep_the_side(working_folder: Path, name: str, side: str) -> None:
    surface = sx.Surface(BALL, hemisphere=side)
    sx.write(name, surface)
    assert sx.read(name).hemisphere == hemisphere_of_file(name) == side
    target = name.replace(".surf", ".shape")
    sx.write(target, HEIGHT, surface)
    assert hemisphere_of_file(target) == side


def test_a_map_beside_a_surface_says_that_its_space_is_lost(working_folder: Path) -> None:
    moved = SpatialFrame(transforms=(CoordinateTransform("a", "b", np.diag([2.0, 1, 1, 1])),))
    with pytest.warns(UserWarning, match="coordinate transforms"):
        sx.write("ball.ply", HEIGHT, sx.Surface(BALL, frame=moved))
    with pytest.warns(UserWarning, match=r"volume geometry \(cras\)"):
        sx.write("ball.surf.gii", sx.Surface(BALL, frame=SpatialFrame(volume={"cras": np.ones(3)})))


@pytest.mark.parametrize(
    ("suffix", "lost"),
    [
        (".vtk", ("hemisphere",)),
        (".vtp", ("hemisphere",)),
        (".off", ("hemisphere", "maps (height)")),
        (".obj", ("hemisphere", "maps (height)")),
        (".stl", ("hemisphere", "maps (height)", "numbers of vertices")),
        (".surf.gii", ("maps (height)",)),
        (".ply", ()),
        (".npz", ()),
    ],
)
def test_what_a_format_cannot_hold_is_said(
    working_folder: Path, suffix: str, lost: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    surface = sx.Surface(BALL, scalars={"height": HEIGHT}, hemisphere="left")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        sx.write(f"ball{suffix}", surface)
    said = [str(one.message) for one in caught]
    assert len(said) == len(lost) and all(any(word in line for line in said) for word in lost)
    assert all(one.filename == __file__ and "\n" not in str(one.message) for one in caught)
    sx.write("from.npz", surface)
    assert main(["convert", "from.npz", f"to{suffix}"]) == 0
    printed = capsys.readouterr().out
    assert all(word in printed for word in lost) and len(printed.strip().splitlines()) == 1 + len(lost)


def test_mask_and_labels_that_are_left_out_are_named(working_folder: Path) -> None:
    parts = LabelMap((HEIGHT > 0).astype(int), {0: "south", 1: "north"})
    surface = sx.Surface(BALL, mask=HEIGHT > 0, labels={"parts": parts})
    with pytest.warns(UserWarning, match=r"labels \(parts\) and mask"):
        sx.write("ball.vtp", surface)


@pytest.mark.parametrize(
    "name", ["rh.ball.off", "rh.ball.ply", "rh.map.csv", "rh.map.npz", "rh.p.label.gii", "rh.sulc"]
)
def test_nothing_is_written_under_the_name_of_the_other_side(working_folder: Path, name: str) -> None:
    surface = sx.Surface(BALL, hemisphere="left")
    labels = LabelMap(np.zeros(COUNT, dtype=int), {0: "all"})
    what = surface if "ball" in name else labels if "label" in name else HEIGHT
    with pytest.raises(ValueError, match="named as the right hemisphere"):
        sx.write(name, what, surface)
    assert not Path(name).exists()


@pytest.mark.parametrize("name", ["m.csv", "m.npz", "m.npy", "m.shape.gii", "m.ply", "m.vtp", "m.mgh"])
def test_a_map_of_another_length_than_its_surface_is_refused(working_folder: Path, name: str) -> None:
    with pytest.raises(ValueError, match="5 values, the surface has 162"):
        sx.write(name, np.ones(5), sx.Surface(BALL))


@pytest.mark.parametrize("name", ["p.label.gii", "p.annot"])
def test_labels_are_written_with_the_names_of_their_keys(working_folder: Path, name: str) -> None:
    table = LabelMap(np.where(HEIGHT > 0.5, 7, np.where(HEIGHT < -0.5, -1, 3)), {7: "north", 3: "middle"})
    sx.write(name, table)
    sx.write("ball.ply", BALL)
    again = sx.read("ball.ply", labels=name).labels["p"]
    assert np.array_equal(again.where("north"), table.where("north"))
    assert np.array_equal(again.where("middle"), table.where("middle")) and set(again.names.values()) == {
        "north",
        "middle",
    }


def test_labels_in_a_column_are_labels(working_folder: Path) -> None:
    keys = np.arange(len(HEIGHT), dtype=np.int32) % 3
    array = nibabel.gifti.GiftiDataArray(keys[:, None], "NIFTI_INTENT_LABEL", datatype="NIFTI_TYPE_INT32")
    nibabel.save(nibabel.gifti.GiftiImage(darrays=[array]), "column.label.gii")
    assert np.array_equal(read_label_map("column.label.gii").keys, keys)
    column = LabelMap(np.arange(COUNT)[:, None], {})
    assert np.array_equal(column.keys, np.arange(COUNT))
    with pytest.raises(ValueError, match=r"shape \(81, 2\)"):
        LabelMap(np.arange(COUNT).reshape(-1, 2), {})
    with pytest.raises(ValueError, match="'a' have 3 entries, the mesh has 162"):
        sx.Surface(BALL, labels={"a": LabelMap(np.arange(3), {})})


def test_files_of_both_sides_are_refused_unless_the_caller_says(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sx.write("rh.ball.off", BALL)
    with pytest.raises(ValueError, match=r"left hemisphere, the surface .* of the right"):
        sx.read("rh.ball.off", maps="lh.thickness.csv")
    sx.write("rh.sulc.csv", HEIGHT)
    with pytest.raises(ValueError, match=r"of the right hemisphere, map .* of the left"):
        sx.read("ball.ply", maps=["lh.thickness.csv", "rh.sulc.csv"])
    assert sx.read("ball.ply", maps="lh.thickness.csv").hemisphere == "left"
    given = sx.read("rh.ball.off", maps="lh.thickness.csv", hemisphere="left")
    assert given.hemisphere == "left" and given.notes == ("rh.ball.off says right; it is taken as left, as given.",)
    arguments = ["smooth", "rh.ball.off", "lh.thickness.csv", "--width", "1", "--to", "smooth.npz"]
    assert main(arguments) == 2 and "of the left hemisphere" in capsys.readouterr().err
    assert main([*arguments, "--hemisphere", "left"]) == 0 and hemisphere_of_file("smooth.npz") == "left"
    assert main(["repair", "rh.ball.off", "--hemisphere", "left", "--to", "mended.ply"]) == 0
    assert hemisphere_of_file("mended.ply") == "left"


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["modes", "ball.ply", "-k", "5", "--to", "m.npy"], "m.npy holds one map, there are 5"),
        (["modes", "ball.ply", "-k", "5", "--to", "m.mgz"], "m.mgz holds one map, there are 5"),
        (["modes", "ball.ply", "-k", "5", "--to", "lh.m"], "lh.m holds one map, there are 5"),
        (["modes", "ball.ply", "-k", "5", "--to", "m.dscalar.nii"], "m.dscalar.nii needs a hemisphere"),
        (["align", "ball.ply", "ball.ply", "-k", "3", "--to", "m.csv"], "two arrays: choose .npz"),
        (["denoise", "ball.ply", "two.csv", "--to", "lh.m"], "lh.m holds one number a vertex, the map has 2"),
        (["smooth", "ball.ply", "two.csv", "--width", "1", "--to", "lh.m"], "one number a vertex, the map has 2"),
    ],
)
def test_a_format_that_is_too_narrow_is_refused_before_anything_is_computed(
    folder: Path, arguments: list[str], says: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: object, **__: object) -> None:
        raise AssertionError("something was computed")

    for function in ("spectra.eigenpairs", "denoising.denoise", "denoising.smooth", "mode_alignment.align"):
        monkeypatch.setattr(f"surfexp.tasks.{function}", never)
    assert main(arguments) == 2
    said = capsys.readouterr().err
    assert says in said and len(said.strip().splitlines()) == 1 and len(said) < 120


@pytest.mark.parametrize("inside", ["surf/lh.pial", "ball.ply", ""])
def test_a_folder_is_refused_with_a_surface_in_it(tmp_path: Path, inside: str) -> None:
    if inside:
        (tmp_path / inside).parent.mkdir(exist_ok=True)
        sx.write(tmp_path / inside, sx.shape("icosphere", levels=1))
    with pytest.raises(ValueError) as refused:
        sx.read(tmp_path)
    rest = f", as {tmp_path / inside}" if inside else ""
    assert str(refused.value) == f"{tmp_path} is a folder: give one file of it{rest}"


@pytest.mark.parametrize(
    ("result", "line"),
    [
        (
            lambda ball, noisy: sx.denoise_path(ball, noisy, weights=(0.5, 1.0)),
            "a DenoisingPath is no map of the surface",
        ),
        (
            lambda ball, noisy: sx.noise(ball, noisy),
            "a FittedNoise is no map of the surface: give an array, such as one of",
        ),
        (lambda ball, noisy: sx.distance(ball, ball, 4), "a Distance is no map of the surface"),
    ],
)
def test_a_result_that_is_no_map_is_refused_with_what_it_holds(result, line: str, working_folder: Path) -> None:
    ball = sx.shape("icosphere", levels=2)
    noisy = ball.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(162)
    with pytest.raises(ValueError, match=line):
        sx.write("result.npz", result(ball, noisy))
