"""A limit of memory that libraries would end the process at is told in one line, with exit code 1."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import pytest

from surfexp.lab import memory_limit
from surfexp.lab.memory_limit import LEAST_FOR_NUMERICS, require_memory


@pytest.mark.parametrize("megabytes", [300, 450])
@pytest.mark.parametrize("words", [["denoise", "a.ply", "b.csv", "--to", "c.csv"], ["run"]], ids=["denoise", "run"])
def test_a_command_without_memory_ends_in_one_line(tmp_path: Path, words: list[str], megabytes: int) -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (megabytes * 10**6,) * 2)

    command = [sys.executable, "-m", "surfexp.commands.command_line", *words]
    done = subprocess.run(command, cwd=tmp_path, preexec_fn=limit, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and not done.stdout
    assert done.stderr.startswith(f"surfexp: too little memory ({megabytes} MB are allowed by ulimit -v")
    assert len(done.stderr.splitlines()) == 1 and "raise the limit" in done.stderr


def test_plugins_are_not_described_without_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from surfexp.lab.registry.contained import contained_description

    monkeypatch.setattr(memory_limit, "_allowed", lambda: LEAST_FOR_NUMERICS - 1)
    with pytest.raises(MemoryError, match="600 MB are needed"):
        contained_description(tmp_path)


def test_no_limit_and_a_wide_one_are_let_through(monkeypatch: pytest.MonkeyPatch) -> None:
    for allowed in (None, LEAST_FOR_NUMERICS, 10 * LEAST_FOR_NUMERICS):
        monkeypatch.setattr(memory_limit, "_allowed", lambda allowed=allowed: allowed)
        require_memory(LEAST_FOR_NUMERICS)
