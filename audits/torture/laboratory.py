"""A folder to work in with one quick experiment, and the `surfexp` command as a person runs it there."""

from __future__ import annotations

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

EXPERIMENT = """# @package _global_
experiment: small
target: solver
title: Small & quick
surface: {name: icosphere, levels: 2}
image: {name: two_phase, noise: 20.0}
model: rof
operator: fem
solver: {name: primal_dual, tolerance: 1.0e-2}
figures: []
grid: {image.seed: [0, 1, 2], operator: [fem, libigl]}
"""
COMMAND = (sys.executable, "-P", "-m", "surfexp.commands.command_line")
LIMIT = 300.0


@dataclass(frozen=True)
class Done:
    """Exit code and what was printed; the code is None where it had to be ended."""

    code: int | None
    out: str
    error: str


@contextmanager
def working_folder() -> Iterator[Path]:
    """An empty folder that holds the experiment `small`."""
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text).resolve()
        (folder / "conf" / "experiment").mkdir(parents=True)
        (folder / "conf" / "experiment" / "small.yaml").write_text(EXPERIMENT)
        yield folder


def start(folder: Path, *arguments: str, **environment: str) -> subprocess.Popen[str]:
    """Begin a command in a session of its own."""
    return subprocess.Popen(
        [*COMMAND, *arguments],
        cwd=folder,
        env=os.environ | environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        errors="replace",
    )


def end(process: subprocess.Popen[str], seconds: float = LIMIT) -> Done:
    """Wait for a command; after the limit its whole session is killed."""
    try:
        out, error = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        out, error = process.communicate()
        return Done(None, out, error)
    return Done(process.returncode, out, error)


def run(folder: Path, *arguments: str, seconds: float = LIMIT, **environment: str) -> Done:
    """Run a command to its end."""
    return end(start(folder, *arguments, **environment), seconds)


def store_bytes(results: Path) -> dict[str, str]:
    """SHA-256 of every stored file, by its place in the store."""
    files = sorted(file for file in (results / "store").rglob("*") if file.is_file() and not file.name.startswith("."))
    return {str(file.relative_to(results)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


def fresh(sound: Path, folder: Path) -> Path:
    """A copy of a sound results folder in place of the one that is there."""
    target = folder / "results"
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(sound, target, symlinks=True)
    return target
