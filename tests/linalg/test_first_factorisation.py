"""What a second process compiles beside a first call: all of the factorisation that comes after the ordering."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from surfexp import first_call
from surfexp.linalg.first_factorisation import factorise_one_number

COMPILED = """
from numba.core import event
class Compiled(event.Listener):
    names = set()
    def on_start(self, begun): self.names.add(begun.data["dispatcher"].py_func.__name__)
    def on_end(self, ended): pass
event.register("numba:compile", Compiled())
import numpy as np
from scipy.sparse import diags_array
from surfexp.linalg.ldlt import ldlt
count = 200
factor = ldlt(diags_array([np.full(count - 1, -1.0), np.full(count, 3.0), np.full(count - 1, -1.0)], offsets=[-1, 0, 1]))
assert np.ptp(factor.solve(np.ones(count)) - factor.solve(np.ones((count, 8)))[:, 3]) < 1e-12
print(" ".join(Compiled.names & {"eliminate", "solve_lanes", "solve_one"}), end="")
"""


def test_the_smallest_matrix_is_solved() -> None:
    assert factorise_one_number() < 1e-15


@pytest.mark.slow
def test_nothing_of_it_is_left_to_compile(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    program = [sys.executable, "-c", COMPILED]

    def left() -> str:
        return subprocess.run(program, env=environment, check=True, capture_output=True, text=True, timeout=300).stdout

    subprocess.run([sys.executable, "-m", first_call.BESIDE], env=environment, check=True, timeout=300)
    assert left() == ""
    # a folder of another kind of kernel holds none of them
    environment["NUMBA_CACHE_DIR"] = str(tmp_path / "empty")
    assert set(left().split()) == {"eliminate", "solve_lanes", "solve_one"}


def test_one_core_compiles_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(first_call, "all_cores", lambda: 1)
    assert first_call.compile_beside() is None


def test_the_second_process_ends_with_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(first_call, "all_cores", lambda: 2)
    at_exit: list[tuple[object, ...]] = []
    monkeypatch.setattr(first_call.atexit, "register", lambda *call: at_exit.append(call))
    beside = first_call.compile_beside()
    ((end, process),) = at_exit
    assert beside is process and beside is not None
    end(process)  # type: ignore[operator]
    assert beside.returncode is not None
