"""Everything that is written is read back equal, or refused in one line before a file is there."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import surfexp as sx
from surfexp.io.hemisphere import hemisphere_of_file
from surfexp.io.map_files import read_maps, read_named_labels
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL, DISK = icosphere(1).mesh, disk(rings=2).mesh
LOOSE = TriangleMesh(np.r_[[[3.0, 3.0, 3.0]], BALL.vertices], BALL.faces + 1)
TWO = TriangleMesh(np.r_[BALL.vertices, BALL.vertices + 5.0], np.r_[BALL.faces, BALL.faces + len(BALL.vertices)])

SURFACES = ["a.ply", "a.npz", "a.vtk", "a.vtp", "a.off", "a.obj", "a.stl", "a.surf.gii", "lh.white", "lh.a.ply"]
MAPS = ["m.npz", "m.npy", "m.csv", "m.txt", "m.dat", "m.mgh", "m.mgz", "m.shape.gii", "m.func.gii"]
MAPS += ["m.dscalar.nii", "m.sulc", "lh.m", "m.ply", "m.vtk", "m.vtp"]
LABELS = ["p.label.gii", "p.annot"]
SINGLE = (".gii", ".stl", ".white", ".mgh", ".mgz", ".nii", ".sulc", "lh.m")

numbers = st.floats(-1e6, 1e6) | st.sampled_from([0.0, -0.0, 1e-30, 1e30, 1e-320, 1e300, 0.1, -7.0])
# fmt: off
odd_names = [
    "1", "nan", "a b", "a_b", "a,b", "a;b", "a;b,c;d", "x", "z", "faces", "vertices", "hemisphere", "file", "allow_pickle", "a.npy",
    "#a", "=1+1", "'=a", '"a"', "é", "ä ö", "<a>&", "]]>", "%20", "map 1",
]
# fmt: on
names = st.text(max_size=6) | st.sampled_from(odd_names)
sides = st.sampled_from(["", "left", "right"])


@st.composite
def meshes(draw: st.DrawFn) -> TriangleMesh:
    mesh = draw(st.sampled_from([BALL, DISK, LOOSE, TWO]))
    shift, unit = draw(st.sampled_from([0.0, 0.3, 1e4])), draw(st.sampled_from([1.0, 1e-3, 1e30, 1e-45, 0.1]))
    return TriangleMesh((mesh.vertices + shift) * unit, mesh.faces)


def maps_on(count: int, channels: int = 1) -> st.SearchStrategy[dict[str, np.ndarray]]:
    shapes = st.integers(1, channels).map(lambda c: (count,) if c == 1 else (count, c))
    values = shapes.flatmap(lambda shape: arrays(np.float64, shape, elements=numbers | st.just(float("nan"))))
    return st.dictionaries(names, values, min_size=1, max_size=3)


@contextmanager
def refused_or_written(path: Path) -> Iterator[None]:
    """What is refused is refused in one line, and no file is there."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            yield
        except ValueError as error:
            said = str(error)
            assert said.isprintable() and 0 < len(said) <= 400, said
            assert not path.exists() and not list(path.parent.iterdir())
            raise _Refused from error


class _Refused(Exception):
    """The refusal was as it should be."""


def trying(write: Callable[[Path], None], name: str, check: Callable[[Path], None]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        try:
            with refused_or_written(path):
                write(path)
        except _Refused:
            return
        check(path)


def rounded(values: np.ndarray, name: str) -> np.ndarray:
    return values.astype(np.float32).astype(np.float64) if name.endswith(SINGLE) else values


def name_in(name: str, file: str) -> str:
    """A PLY file writes white space in a name as an underscore."""
    return "_".join(name.split()) if file.endswith(".ply") else name


def channels_of(maps: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    flat = {}
    for name, values in maps.items():
        flat |= {name: values} if values.ndim == 1 else {f"{name} {k}": values[:, k] for k in range(values.shape[1])}
    return flat


def same_maps(found: dict[str, Any], wanted: dict[str, np.ndarray], file: str) -> None:
    assert list(found) == [name_in(name, file) for name in wanted]
    for got, values in zip(found.values(), wanted.values(), strict=True):
        assert np.array_equal(got, rounded(values, file), equal_nan=True)


@settings(max_examples=150)
@pytest.mark.parametrize("name", SURFACES)
@given(data=st.data())
def test_surfaces_with_maps(name: str, data: st.DataObject) -> None:
    mesh, side = data.draw(meshes()), data.draw(sides)
    maps = data.draw(maps_on(len(mesh.vertices)) | st.just({}))
    surface = sx.Surface(mesh, scalars=maps, hemisphere=side)

    def check(path: Path) -> None:
        again = sx.read(path)
        points = rounded(mesh.vertices, name)
        if name.endswith(".stl"):
            assert np.array_equal(again.mesh.vertices[again.mesh.faces], points[mesh.faces])
        else:
            assert np.array_equal(again.mesh.vertices, points) and np.array_equal(again.mesh.faces, mesh.faces)
        holds = name.endswith((".ply", ".npz", ".gii", ".dscalar.nii"))
        assert again.hemisphere == (
            side or ("left" if name.startswith("lh.") else "") if holds or "lh." in name else ""
        )
        same_maps(again.scalars, maps if name.endswith((".ply", ".npz", ".vtk", ".vtp")) else {}, name)

    trying(lambda path: sx.write(path, surface), name, check)


@settings(max_examples=150)
@pytest.mark.parametrize("name", MAPS)
@given(data=st.data())
def test_maps_and_masks(name: str, data: st.DataObject) -> None:
    mesh, side = LOOSE, data.draw(sides)
    maps = data.draw(maps_on(len(mesh.vertices), channels=3))
    surface = sx.Surface(mesh, hemisphere=side)

    def check(path: Path) -> None:
        beside = name.endswith((".ply", ".vtk", ".vtp"))
        found = dict(sx.read(path).scalars) if beside else read_maps(path, side)
        wanted = maps if name.endswith((".npz", ".npy", ".mgh", ".mgz")) else channels_of(maps)
        if (
            len(wanted) == 1
            and not beside
            and (next(iter(wanted)) in ("map", "map 1") or next(iter(found)) in ("m", "lh.m"))
        ):
            found = {next(iter(wanted)): next(iter(found.values()))}
        if name.endswith((".txt", ".dat")):
            found = dict(zip(wanted, found.values(), strict=True))
        columns = {key: v[:, 0] if v.ndim == 2 and v.shape[1] == 1 else v for key, v in wanted.items()}
        same_maps(found, columns, name)
        said = name.startswith("lh.") or name.endswith((".ply", ".npz", ".gii", ".dscalar.nii"))
        assert hemisphere_of_file(path) == ((side or ("left" if name.startswith("lh.") else "")) if said else "")

    trying(lambda path: sx.write(path, maps, surface), name, check)
    inside = data.draw(arrays(bool, len(mesh.vertices)))

    def check_mask(path: Path) -> None:
        with tempfile.TemporaryDirectory() as folder:
            sx.write(Path(folder) / "s.npz", surface)
            again = sx.read(Path(folder) / "s.npz", mask=path) if inside[1:].all() else None
            if again is not None:
                assert np.array_equal(again.mask, inside)

    if not name.endswith((".ply", ".vtk", ".vtp")):
        trying(lambda path: sx.write(path, inside, surface), name, check_mask)


@settings(max_examples=300)
@pytest.mark.parametrize("name", LABELS)
@given(data=st.data())
def test_labels(name: str, data: st.DataObject) -> None:
    table = data.draw(st.dictionaries(st.integers(-2, 12) | st.integers(-(2**33), 2**33), names, max_size=5))
    used = st.sampled_from([*table, -1]) if table else st.integers(-1, 3)
    keys = data.draw(arrays(np.int64, len(BALL.vertices), elements=used))
    if len(set(table.values())) < len(table):
        with pytest.raises(ValueError, match="stands for two labels"):
            LabelMap(keys, table)
        return
    labels, side = LabelMap(keys, table), data.draw(sides)

    def check(path: Path) -> None:
        found = read_named_labels(path)
        assert set(found.names.values()) == set(table.values())
        for named in table.values():
            assert np.array_equal(found.where(named), labels.where(named))
        if name.endswith(".gii"):
            assert np.array_equal(found.keys, keys) and dict(found.names) == table
            assert hemisphere_of_file(path) == side
        assert np.array_equal(np.isin(found.keys, list(found.names)), np.isin(keys, list(table)))

    trying(lambda path: sx.write(path, labels, sx.Surface(BALL, hemisphere=side)), name, check)
