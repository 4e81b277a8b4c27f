"""Compiled code lies in the user's cache folder, is read from nobody else's, and is compiled again where it is damaged."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from surfexp.lab.running import compiled_code

PROGRAM = """
import sys
from surfexp.lab.running import compiled_code
compiled_code.use("state")
sys.path.insert(0, sys.argv[1])
import function
value = function.twice({argument})
hits = sum(function.twice.stats.cache_hits.values())
print(value, hits, *compiled_code.complaints(), sep="|")
"""
FUNCTION = """
import numba

@numba.njit(cache=True)
def twice(x):
    return 2 * x
"""


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    compiled_code.choose.cache_clear()
    (tmp_path / "function.py").write_text(FUNCTION)
    return tmp_path / "cache" / "surfexp" / "compiled"


def call(folder: Path, argument: str = "1.5") -> list[str]:
    command = [sys.executable, "-c", PROGRAM.format(argument=argument), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().split("|")


def test_a_second_process_finds_the_code_of_the_first(cache: Path, tmp_path: Path) -> None:
    assert call(tmp_path) == ["3.0", "0"]
    assert call(tmp_path) == ["3.0", "1"]
    assert call(tmp_path, "3") == ["6", "0"] and call(tmp_path, "3") == ["6", "1"]
    assert oct((cache / "state").stat().st_mode)[-2:] == "00"


@pytest.mark.parametrize(
    ("damage", "suffix"),
    [
        ("flip", "nbc"),
        ("cut", "nbi"),
        pytest.param("flip", "nbi", marks=pytest.mark.slow),
        pytest.param("cut", "nbc", marks=pytest.mark.slow),
        pytest.param("empty", "nbi", marks=pytest.mark.slow),
        pytest.param("empty", "nbc", marks=pytest.mark.slow),
    ],
)
def test_damaged_code_is_compiled_again_and_named(cache: Path, tmp_path: Path, suffix: str, damage: str) -> None:
    call(tmp_path)
    (file,) = cache.rglob(f"*.{suffix}")
    data = file.read_bytes()
    middle = len(data) // 2
    flipped = data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :]
    file.write_bytes({"flip": flipped, "cut": data[:middle], "empty": b""}[damage])
    value, hits, complaint = call(tmp_path)
    assert (value, hits) == ("3.0", "0") and complaint.startswith(f"damaged compiled code in {cache}")
    assert call(tmp_path) == ["3.0", "1"]


def test_a_full_disk_is_no_failure(cache: Path, tmp_path: Path) -> None:
    limited = "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)"
    limited += "; resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))"
    command = [sys.executable, "-c", limited + PROGRAM.format(argument="1.5"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True)
    value, hits, complaint = done.stdout.strip().split("|")
    assert (value, hits) == ("3.0", "0") and complaint.startswith("compiled code cannot be kept")


def test_two_processes_that_compile_for_two_signatures_write_two_files(cache: Path, tmp_path: Path) -> None:
    from surfexp.lab.running.numba_cache import CheckedFiles

    first, second = (CheckedFiles(str(tmp_path), "function", "stamp") for _ in range(2))
    write = first._save_data

    def overtaken(name: str, data: object) -> None:
        second._load_index = dict  # read before the first wrote its index
        second.save("of integers", 1)
        write(name, data)

    first._save_data = overtaken
    first.save("of floats", 2.0)
    found = CheckedFiles(str(tmp_path), "function", "stamp")
    assert found.load("of integers") == 1 and found.load("of floats") is None


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o777])
def test_a_folder_that_others_can_write_is_left_alone(cache: Path, tmp_path: Path, mode: int) -> None:
    cache.mkdir(parents=True)
    cache.chmod(mode)
    folder, reason = compiled_code.choose("state")
    assert folder == tmp_path / f"surfexp-compiled-{os.getuid()}" / "state"
    assert f"{cache} can be written by others (mode {mode:o})" in reason and list(cache.iterdir()) == []


def test_a_folder_of_somebody_else_is_left_alone(cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache.mkdir(parents=True)
    monkeypatch.setattr(os, "getuid", lambda: cache.stat().st_uid + 1)
    folder, reason = compiled_code.choose("state")
    assert f"{cache} belongs to another user" in reason and "compiled code is not kept" in reason
    assert folder.is_relative_to(Path(compiled_code._temporary[-1].name)) and list(cache.iterdir()) == []


def test_without_a_home_a_folder_of_the_user_among_temporary_files_takes_its_place(cache: Path, tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("a file where the cache folder should be")
    folder, reason = compiled_code.choose("state")
    assert folder == tmp_path / f"surfexp-compiled-{os.getuid()}" / "state" and "cannot be written" in reason
    assert oct(folder.parent.stat().st_mode)[-2:] == "00"


def test_the_code_of_the_latest_states_stays(cache: Path, tmp_path: Path) -> None:
    for number in range(compiled_code.STATES_KEPT + 2):
        folder, _ = compiled_code.choose(f"state{number}")
        os.utime(folder, (number, number))
    assert len(list(cache.iterdir())) == compiled_code.STATES_KEPT and not (cache / "state0").exists()
    assert folder.exists()
