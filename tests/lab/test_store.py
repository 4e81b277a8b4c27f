"""The store gives back what was written or says that it cannot: every bit of a result counts."""

from __future__ import annotations

import json
import resource
import shutil
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import csr_array

from surfexp.lab.errors import DamagedResult
from surfexp.lab.store import store
from surfexp.lab.store.kinds import stage_kind
from surfexp.lab.store.result_tree import encoded
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

KEY = "ab" * 10


@dataclass(frozen=True, eq=False)
class Assorted:
    values: np.ndarray
    matrix: csr_array
    pairs: tuple[tuple[float, int], ...]
    history: dict[str, np.ndarray]
    mesh: TriangleMesh
    name: str = "größe"
    nothing: None = None
    labels: dict[int, str] = field(default_factory=lambda: {3: "insula", -1: "none"})
    levels: dict[float, tuple[int, ...]] = field(default_factory=lambda: {0.1: (1,), 1e-300: ()})
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


stage_kind("assorted", Assorted)


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    results = tmp_path_factory.mktemp("results")
    generator = np.random.default_rng(7)
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    result = Assorted(
        generator.normal(size=(5, 3)),
        csr_array(np.eye(4) + np.eye(4, k=1)),
        ((0.1, 3), (1e-300, -1)),
        {"iteration": np.arange(3.0), "gap": np.array([1.0, 0.1, 0.01])},
        mesh,
        metrics={"energy": 1 / 3, "undefined": float("nan")},
        notes=("one", "two"),
    )
    store.save(results, "assorted", KEY, result)
    return results


@pytest.mark.parametrize("room", [0, 100, 1500])
def test_a_result_without_room_leaves_nothing(stored: Path, tmp_path: Path, room: int) -> None:
    result = store.load(stored, "assorted", KEY)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, before[1]))
    try:
        with pytest.raises(OSError, match=r"large|written"):
            store.save(tmp_path, "assorted", KEY, result)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert not store.is_done(tmp_path, "assorted", KEY)
    assert not [path for path in tmp_path.rglob("*") if path.is_file() and path.name != store.ARRAYS]


def copy(stored: Path, folder: Path) -> Path:
    shutil.copytree(stored, folder / "copy")
    return folder / "copy"


def files(results: Path) -> tuple[Path, Path]:
    folder = store.result_folder(results, "assorted", KEY)
    return folder / "record.json", folder / "arrays.npz"


def test_a_result_comes_back_with_every_digit(stored: Path) -> None:
    back = store.load(stored, "assorted", KEY)
    assert back.values.tobytes() == np.random.default_rng(7).normal(size=(5, 3)).tobytes()
    assert back.pairs == ((0.1, 3), (1e-300, -1)) and back.name == "größe" and back.nothing is None
    assert back.metrics["energy"] == 1 / 3 and np.isnan(back.metrics["undefined"])
    assert (back.matrix.toarray() == np.eye(4) + np.eye(4, k=1)).all()
    assert store.load(stored, "assorted", KEY, "history")["gap"].tolist() == [1.0, 0.1, 0.01]
    assert store.load(stored, "assorted", KEY, "colour") is None
    assert back.labels == {3: "insula", -1: "none"} and back.levels == {0.1: (1,), 1e-300: ()}
    assert store.faults(stored, [("assorted", KEY), ("assorted", "cd")]) == {"cd": ""}


@pytest.mark.parametrize("keys", [[1, "one"], [(1, 2)], [True, "no"], [None]])
def test_keys_that_would_come_back_as_others_are_refused(keys: list[object], tmp_path: Path) -> None:
    with pytest.raises(TypeError, match=r"^labels has keys .*all of one type"):
        encoded({"labels": dict.fromkeys(keys, "x")}, "", {})


@dataclass(frozen=True, eq=False)
class Finer(Surface):
    detail: float = 1.0


def test_what_could_not_be_read_back_is_not_stored(stored: Path, tmp_path: Path) -> None:
    @dataclass
    class Local:
        value: float

    mesh = store.load(stored, "assorted", KEY).mesh
    with pytest.raises(TypeError, match="returned Finer, which is stored as no surface: return Surface itself"):
        store.save(tmp_path, "surface", KEY, Finer(mesh))
    with pytest.raises(TypeError, match=r"^labels could not be read back: stored class .*Local' is not a dataclass"):
        encoded(Local(1.0), "/labels", {})
    assert not store.is_done(tmp_path, "surface", KEY) and not list(tmp_path.iterdir())


def test_a_flip_of_any_bit_is_detected_and_named(stored: Path, tmp_path: Path) -> None:
    results = copy(stored, tmp_path)
    for file in files(results):
        whole = file.read_bytes()
        for place in range(len(whole)):  # every byte, and its bits in turn
            damaged = bytearray(whole)
            damaged[place] ^= 1 << place % 8
            file.write_bytes(damaged)
            with pytest.raises(DamagedResult, match=rf"assorted/{KEY} is damaged: .*{file.name}"):
                store.load(results, "assorted", KEY)
        file.write_bytes(whole)
    assert store.load(results, "assorted", KEY).notes == ("one", "two")


def test_faults_see_what_has_changed_since_it_was_hashed(stored: Path, tmp_path: Path) -> None:
    results = copy(stored, tmp_path)
    stages = [("assorted", KEY)]
    for file in files(results):
        whole = file.read_bytes()
        for place in range(0, len(whole), len(whole) // 20):
            assert store.faults(results, stages) == {}
            damaged = bytearray(whole)
            damaged[place] ^= 16
            file.write_bytes(damaged)
            assert "is damaged" in store.faults(results, stages)[KEY], (file, place)
            file.write_bytes(whole)
    for change in (lambda data: data[:-1], lambda data: b"", lambda data: data + b"\n"):
        for file in files(results):
            whole = file.read_bytes()
            file.write_bytes(change(whole))
            assert "is damaged" in store.faults(results, stages, anew=True)[KEY]
            file.write_bytes(whole)
    files(results)[1].unlink()
    assert "arrays.npz is missing" in store.faults(results, stages)[KEY]
    (results / "cache" / "verified.json").write_text("[3")  # what was seen before is a help, never needed
    assert "arrays.npz is missing" in store.faults(results, stages)[KEY]


def test_what_belongs_to_another_result_is_refused(stored: Path, tmp_path: Path) -> None:
    results = copy(stored, tmp_path)
    record, arrays = files(results)
    foreign = {name: array + 1 for name, array in np.load(arrays).items()}
    np.savez(arrays, **foreign)  # well formed, and not what was written
    with pytest.raises(DamagedResult, match=r"arrays.npz does not have the digest in record.json"):
        store.load(results, "assorted", KEY)

    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    store.save(results, "surface", KEY, Surface(mesh))
    shutil.copytree(store.result_folder(results, "surface", KEY), record.parent, dirs_exist_ok=True)
    with pytest.raises(DamagedResult, match=f"its record.json is that of surface/{KEY} of class surface"):
        store.load(results, "assorted", KEY)
    other = store.result_folder(results, "surface", "ef" * 10)
    shutil.copytree(store.result_folder(results, "surface", KEY), other)
    with pytest.raises(DamagedResult, match=f"is that of surface/{KEY}"):
        store.load(results, "surface", other.name)


def test_a_result_without_digests_is_said_to_be_of_an_earlier_version(stored: Path, tmp_path: Path) -> None:
    results = copy(stored, tmp_path)
    record, _ = files(results)
    record.write_text(json.dumps(json.loads(record.read_text())["result"], indent=1, sort_keys=True) + "\n")
    assert "of an earlier version, which stored no digests" in store.faults(results, [("assorted", KEY)])[KEY]


def test_a_store_of_older_keys_says_so_once(tmp_path: Path) -> None:
    old = tmp_path / "store" / "surface" / "0123" / store.RECORD
    old.parent.mkdir(parents=True)
    old.write_text("{}")
    assert "computed again" in store.note_on_older_keys(tmp_path)
    assert store.note_on_older_keys(tmp_path) == ""
    assert store.note_on_older_keys(tmp_path / "new") == ""
