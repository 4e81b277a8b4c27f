"""Results on a file system of several machines: no locks, coarse and foreign clocks, processes of one number."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from surfexp.commands import results_lock
from surfexp.lab.store import store
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

SURFACE = Surface(TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])))


def test_two_machines_that_save_one_result_at_once_leave_it_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second comes, with a process of the same number, when the first has written its arrays and not yet moved them."""
    sha256, machines = store._sha256, ["second"]

    def interrupted(file: Path) -> Any:
        if machines:
            monkeypatch.setattr(store, "HOST", machines.pop())
            store.save(tmp_path, "surface", "0" * 20, SURFACE)
        return sha256(file)

    monkeypatch.setattr(store, "_sha256", interrupted)
    monkeypatch.setattr(store, "HOST", "first")
    store.save(tmp_path, "surface", "0" * 20, SURFACE)
    assert not machines and store.faults(tmp_path, [("surface", "0" * 20)]) == {}
    assert store.load(tmp_path, "surface", "0" * 20).mesh.faces.tolist() == [[0, 1, 2]]
    assert sorted(path.name for path in store.result_folder(tmp_path, "surface", "0" * 20).iterdir()) == [
        "arrays.npz",
        "record.json",
    ]


@pytest.mark.parametrize("shift", [-86_400, 0, 86_400])
def test_results_are_done_whatever_the_times_of_their_files(tmp_path: Path, shift: int) -> None:
    store.save(tmp_path, "surface", "0" * 20, SURFACE)
    for file in tmp_path.rglob("*"):
        whole = int(file.stat().st_mtime) // 2 * 2 + shift
        os.utime(file, (whole, whole))
    assert store.is_done(tmp_path, "surface", "0" * 20)
    assert store.faults(tmp_path, [("surface", "0" * 20)]) == {}


def test_a_folder_that_cannot_be_locked_is_worked_in_with_a_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def no_locks(descriptor: int, how: int) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(results_lock.fcntl, "flock", no_locks)
    monkeypatch.setattr(results_lock, "locks", [])
    monkeypatch.delenv(results_lock.HELD, raising=False)
    results_lock.hold_results(tmp_path)
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"surfexp: {tmp_path} cannot be locked (No locks available): let one run at a time work there"
    for descriptor in results_lock.locks:
        os.close(descriptor)
