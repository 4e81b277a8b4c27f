"""A disk without room and too little memory: said in one line with exit code 1, and nothing waits for ever."""

from __future__ import annotations

import errno
import io
import resource
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.commands.error_line import lacking, tell
from surfexp.io.replacing import replacing


@pytest.fixture
def small_files(working_folder: Path) -> Iterator[Path]:
    sx.write("ball.ply", sx.shape("icosphere", levels=2))
    sx.eigenpairs("ball.ply", 4)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    yield working_folder
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("target", ["m.npz", "m.csv", "m.vtk", "m.vtp", "m.ply", "m.func.gii"])
def test_a_result_without_room_is_named_and_leaves_nothing(
    small_files: Path, target: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["modes", "ball.ply", "-k", "4", "--to", target]) == 1
    said = capsys.readouterr()
    assert f"{target} cannot be written" in said.err and "free some space" in said.err
    assert len(said.err.strip().splitlines()) == 1 and not said.out
    assert [path.name for path in small_files.iterdir()] == ["ball.ply"]


def test_a_short_write_that_has_no_number_is_a_full_disk(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="no room") as caught, replacing(tmp_path / "a.npy"):
        raise OSError("162 requested and 0 written")
    assert caught.value.errno == errno.ENOSPC and caught.value.filename == str(tmp_path / "a.npy")


def test_too_little_memory_is_no_mistake_of_the_user(capsys: pytest.CaptureFixture[str]) -> None:
    for error in (MemoryError("Unable to allocate 4 TiB"), OSError(errno.ENOMEM, "Cannot allocate memory")):
        assert tell(error) == 1
        assert "too little memory" in capsys.readouterr().err
    assert not lacking(FileNotFoundError(errno.ENOENT, "No such file", "a.ply"))


def test_control_codes_are_shown_as_text(capsys: pytest.CaptureFixture[str]) -> None:
    tell(ValueError("no file \x1b[2J\x07lh.white"))
    said = capsys.readouterr().err
    assert "\x1b" not in said and "\\x1b[2J\\x07lh.white" in said


def test_snakemake_hears_of_a_lost_process_where_nothing_can_be_written(monkeypatch: pytest.MonkeyPatch) -> None:
    executor = pytest.importorskip("surfexp.lab.running.executor")

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(executor, "write_death", full)
    monkeypatch.setattr(executor, "read_plan", lambda path: SimpleNamespace(nodes={"key": None}))
    told: list[str] = []
    process = object.__new__(executor.WarmProcess)
    process.executor = SimpleNamespace(report_job_error=lambda info, msg: told.append(info))
    process.plan_path, process.jobs, process.lost = Path("r/plans/p.json"), {"key": "job"}, False
    process.turn, process.process = executor.threading.Lock(), SimpleNamespace(stdout=io.BytesIO(), wait=lambda: 1)
    process._listen()
    assert told == ["job"] and process.lost
