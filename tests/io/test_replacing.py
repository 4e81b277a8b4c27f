"""Files are whole or not there; what is written is read again, or refused by name."""

from __future__ import annotations

import string
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import surfexp as sx
from surfexp.io.map_files import read_maps
from surfexp.io.replacing import check_writable, replacing

BALL = sx.shape("icosphere", levels=2)
HEIGHT = BALL.mesh.vertices[:, 2]


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    target = tmp_path / "lh.result.npz"
    target.write_text("old")

    def fail() -> None:
        with replacing(target) as temporary:
            assert temporary.name == target.name
            temporary.write_text("half")
            assert target.read_text() == "old"
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert target.read_text() == "old" and list(tmp_path.iterdir()) == [target]


def test_a_file_is_replaced_whole_with_its_permissions(tmp_path: Path) -> None:
    target, link = tmp_path / "result.csv", tmp_path / "link.csv"
    target.write_text("old")
    target.chmod(0o640)
    link.symlink_to(target)
    with replacing(link) as temporary:
        temporary.write_text("new")
    assert target.read_text() == "new" and target.stat().st_mode & 0o777 == 0o640 and link.is_symlink()
    with replacing(Path("/dev/null")) as device:
        assert device == Path("/dev/null")


def test_what_cannot_be_written_is_named(tmp_path: Path) -> None:
    for target, words in ((tmp_path, "is a folder"), (tmp_path / "no" / "x.csv", "there is no folder")):
        with pytest.raises(ValueError, match=words):
            check_writable(target)


def test_a_colour_is_one_in_ply_and_three_columns_elsewhere(tmp_path: Path) -> None:
    colour = np.random.default_rng(0).integers(0, 256, (len(HEIGHT), 3)).astype(float)
    sx.write(tmp_path / "ball.ply", {"colour": colour, "height": HEIGHT}, BALL)
    head = (tmp_path / "ball.ply").read_bytes().split(b"end_header")[0].decode()
    assert [line for line in head.splitlines() if "uchar" in line and "list" not in line] == [
        "property uchar red",
        "property uchar green",
        "property uchar blue",
    ]
    again = sx.read(tmp_path / "ball.ply")
    assert np.array_equal(np.stack([again.scalars[name] for name in ("red", "green", "blue")], axis=1), colour)
    assert np.array_equal(again.scalars["height"], HEIGHT)
    for name in ("a.npz", "a.npy", "a.mgh", "a.shape.gii", "a.csv"):
        sx.write(tmp_path / name, colour, BALL)
        maps = sx.read(tmp_path / "ball.ply", maps={"c": tmp_path / name}).scalars
        columns = [values for key, values in maps.items() if key.startswith("c")]
        assert np.array_equal(np.stack(columns, axis=1), colour), name


def test_no_two_maps_become_one(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="'a b' and 'a_b' are both called 'a_b'"):
        sx.write(tmp_path / "ball.ply", {"a b": HEIGHT, "a_b": HEIGHT}, BALL)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("names", [("a b", "a_b"), ("50 %", "a%20b"), ('say "a"', "tiefe über"), ("x", "POINT_DATA")])
def test_vtk_keeps_names_of_several_words_as_its_own_programs_write_them(
    tmp_path: Path, names: tuple[str, str]
) -> None:
    sx.write(tmp_path / "ball.vtk", {names[0]: HEIGHT, names[1]: -HEIGHT}, BALL)
    assert b"a%20b" in (tmp_path / "ball.vtk").read_bytes() or "a b" not in names
    found = sx.read(tmp_path / "ball.vtk").scalars
    assert np.array_equal(found[names[0]], HEIGHT) and np.array_equal(found[names[1]], -HEIGHT)


@pytest.mark.parametrize("name", ["", " ", "a\nb", "a\0b", "\x1b[31m"])
@pytest.mark.parametrize("suffix", [".ply", ".vtk", ".vtp", ".npz", ".csv", ".shape.gii"])
def test_a_name_that_cannot_be_read_again_is_refused(tmp_path: Path, suffix: str, name: str) -> None:
    with pytest.raises(ValueError, match="rename the map"):
        sx.write(tmp_path / f"ball{suffix}", {name: HEIGHT}, BALL)


def test_a_name_is_as_long_as_vtk_reads_it(tmp_path: Path) -> None:
    sx.write(tmp_path / "ball.vtk", {"x" * 255: HEIGHT}, BALL)
    assert list(sx.read(tmp_path / "ball.vtk").scalars) == ["x" * 255]
    for name in ("x" * 256, "ü" * 50):
        with pytest.raises(ValueError, match=r"\.vtk holds 255: rename the map"):
            sx.write(tmp_path / "ball.vtk", {name: HEIGHT}, BALL)


def test_a_map_called_as_a_coordinate_is_refused_in_ply(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="its own x"):
        sx.write(tmp_path / "ball.ply", {"x": HEIGHT}, BALL)


@pytest.mark.parametrize("suffix", [".ply", ".vtk", ".vtp", ".npz"])
def test_a_map_of_another_length_is_refused(tmp_path: Path, suffix: str) -> None:
    if suffix != ".npz":
        with pytest.raises(ValueError, match="5 values"):
            sx.write(tmp_path / f"ball{suffix}", {"a": np.zeros(5)}, BALL)
    with pytest.raises(ValueError, match="one for each vertex of one surface"):
        sx.write(tmp_path / "maps.csv", {"a": np.zeros(5), "b": np.zeros(6)})


NAMES = st.text(string.ascii_letters + string.digits + "_ -.", min_size=1, max_size=8).map(str.strip).filter(bool)


@given(
    names=st.lists(NAMES, min_size=1, max_size=3, unique=True),
    suffix=st.sampled_from([".ply", ".vtk", ".vtp"]),
    channels=st.sampled_from([1, 3]),
    seed=st.integers(0, 99),
)
def test_what_is_written_with_a_surface_is_read_again(
    tmp_path_factory: pytest.TempPathFactory, names: list[str], suffix: str, channels: int, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    size = (len(HEIGHT),) if channels == 1 else (len(HEIGHT), channels)
    maps = {name: rng.standard_normal(size) for name in names}
    target = tmp_path_factory.mktemp("written") / f"ball{suffix}"
    try:
        sx.write(target, maps, BALL)
    except ValueError as refused:
        assert "rename" in str(refused) and not target.exists()
        return
    again = sx.read(target)
    expected = [values if channels == 1 else values[:, k] for values in maps.values() for k in range(channels)]
    assert len(again.scalars) == len(expected)
    for found, values in zip(again.scalars.values(), expected, strict=True):
        assert np.array_equal(found, values)
    assert np.array_equal(again.mesh.vertices, BALL.mesh.vertices)


@given(
    suffix=st.sampled_from([".npz", ".npy", ".csv", ".txt", ".mgh", ".mgz", ".shape.gii", ".func.gii"]),
    holes=st.booleans(),
    seed=st.integers(0, 99),
)
def test_a_map_that_is_written_is_read_again(
    tmp_path_factory: pytest.TempPathFactory, suffix: str, holes: bool, seed: int
) -> None:
    values = np.random.default_rng(seed).standard_normal(len(HEIGHT)).astype(np.float32).astype(float)
    values[:5] = np.nan if holes else values[:5]
    target = tmp_path_factory.mktemp("written") / f"lh.map{suffix}"
    sx.write(target, values, BALL)
    (found,) = read_maps(target).values()
    assert np.array_equal(found.ravel(), values, equal_nan=True)
