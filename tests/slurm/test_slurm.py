"""Experiments as jobs of a real Slurm: the same bytes as on this machine, and whoever waits hears why."""

from __future__ import annotations

import importlib.util
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from one_node_cluster import asked, one_node_cluster, reason_against

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bool(reason_against()), reason=reason_against()),
    pytest.mark.skipif(
        importlib.util.find_spec("snakemake_executor_plugin_slurm") is None,
        reason="pip install snakemake-executor-plugin-slurm",
    ),
]
EXPERIMENT = """\
title: Spectra of two spheres
target: eigensolver
operator: fem
eigensolver: {slicing: {count: 10}}
variants:
  - surface: {icosphere: {levels: 2}}
  - surface: {icosphere: {levels: 3}}
"""


@pytest.fixture(scope="module", autouse=True)
def slurm() -> Iterator[Path]:
    """The cluster of all these tests."""
    with one_node_cluster() as folder:
        yield folder


@pytest.fixture
def folder(working_folder: Path) -> Path:
    """Where an experiment of two surfaces waits to be run."""
    (working_folder / "conf" / "experiment").mkdir(parents=True)
    (working_folder / "conf" / "experiment" / "spheres.yaml").write_text(EXPERIMENT)
    return working_folder


def command(experiment: str, *arguments: str) -> list[str]:
    return [sys.executable, "-m", "surfexp.commands.command_line", "run", f"experiment={experiment}", *arguments]


def bytes_of(results: Path) -> dict[str, bytes]:
    files = (results / "store").glob("*/*/*")
    return {str(file.relative_to(results)): file.read_bytes() for file in files if not file.name.startswith(".")}


def start(folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        command("spheres", "profile=profiles/slurm"),
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def wait_for(text: str, *question: str, seconds: float = 60.0) -> list[str]:
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if found := [line for line in asked(*question).splitlines() if text in line]:
            return found
        time.sleep(0.5)
    raise TimeoutError(f"{question} does not say {text!r} within {seconds:g} s")


def test_quickstart_gives_the_same_bytes(folder: Path) -> None:
    for place, profile in (("here", []), ("there", ["profile=profiles/slurm"])):
        done = subprocess.run(command("quickstart", f"results={place}", *profile), cwd=folder, capture_output=True)
        assert done.returncode == 0, done.stderr.decode()
    here = bytes_of(folder / "here")
    assert len(here) >= 33 and here == bytes_of(folder / "there")
    jobs = asked("squeue", "--noheader", "--states=COMPLETED", "--format=%i").splitlines()
    assert len(jobs) >= 10


def test_a_cancelled_job_is_named_and_the_same_command_continues(folder: Path) -> None:
    run = start(folder)
    (job, *_) = wait_for("operator", "squeue", "--noheader", "--states=PENDING,RUNNING", "--format=%i %k")
    subprocess.run(["scancel", job.split()[0]], check=True)
    said, _ = run.communicate(timeout=120)
    assert run.returncode == 1, said
    assert f"its job {job.split()[0]} in Slurm ended as CANCELLED; see /" in said
    assert "Traceback" not in said
    again = start(folder)
    said, _ = again.communicate(timeout=120)
    assert again.returncode == 0, said


def test_a_node_that_is_drained_is_named_while_one_waits(folder: Path) -> None:
    (node,) = asked("sinfo", "--noheader", "--format=%n").splitlines()
    subprocess.run(["scontrol", "update", f"nodename={node}", "state=drain", "reason=the disk is full"], check=True)
    try:
        run = start(folder)
        assert run.stdout is not None
        warning = next(line for line in run.stdout if "waiting in Slurm's queue" in line)
    finally:
        subprocess.run(["scontrol", "update", f"nodename={node}", "state=resume"], check=True)
    assert "surfexp: warning" in warning and f"({node}: the disk is full)" in warning
    run.send_signal(signal.SIGINT)
    said, _ = run.communicate(timeout=60)
    assert run.returncode == 130, said
    assert not asked("squeue", "--noheader", "--states=PENDING,RUNNING", "--format=%i")
