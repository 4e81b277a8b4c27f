"""Experiments as jobs of a real Slurm: the same bytes as on this machine, and whoever waits hears why."""

from __future__ import annotations

import importlib.util
import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest
from one_node_cluster import one_node_cluster, reason_against

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bool(reason_against()), reason=reason_against()),
    pytest.mark.skipif(
        importlib.util.find_spec("snakemake_executor_plugin_slurm") is None,
        reason="pip install snakemake-executor-plugin-slurm",
    ),
]
ROOT = Path(__file__).resolve().parent.parent.parent
SLEEPER = """
import time
from pathlib import Path
import numpy as np
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.lab.registry.registry import register

@register("surface", "sleeping")
def sleeping() -> Surface:
    while not Path("awake").exists():
        time.sleep(0.1)
    return Surface(TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])))
"""


@pytest.fixture(scope="module", autouse=True)
def slurm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The cluster of all these tests."""
    with (
        one_node_cluster(tmp_path_factory.mktemp("slurm")) as variables,
        pytest.MonkeyPatch.context() as environment,
    ):
        for name, value in variables.items():
            environment.setenv(name, value)
        yield


@pytest.fixture
def folder(working_folder: Path) -> Path:
    """Where experiments are written and run."""
    return working_folder


def write(folder: Path, experiment: str, text: str) -> None:
    (folder / "conf" / "experiment").mkdir(parents=True, exist_ok=True)
    (folder / "conf" / "experiment" / f"{experiment}.yaml").write_text(text)


def command(experiment: str, *arguments: str) -> list[str]:
    return [sys.executable, "-m", "surfexp.commands.command_line", "run", f"experiment={experiment}", *arguments]


def run(folder: Path, experiment: str, *arguments: str) -> None:
    done = subprocess.run(command(experiment, *arguments), cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@contextmanager
def started(folder: Path, experiment: str) -> Iterator[subprocess.Popen[str]]:
    """A run through Slurm that goes on beside the test, and does not outlive it."""
    asked = command(experiment, "profile=profiles/slurm")
    going = subprocess.Popen(asked, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        yield going
    finally:
        going.kill()


def said(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def bytes_of(results: Path) -> dict[str, bytes]:
    files = (results / "store").glob("*/*/*")
    return {str(file.relative_to(results)): file.read_bytes() for file in files if not file.name.startswith(".")}


def wait_for(reached: Callable[[], Any], seconds: float = 60.0) -> Any:
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if found := reached():
            return found
        time.sleep(0.2)
    raise TimeoutError(f"not reached within {seconds:g} s")


def only(lines: list[str]) -> str:
    """The line, where there is one."""
    return lines[0] if len(lines) == 1 else ""


@dataclass
class Cost:
    """What a run through Slurm took: its jobs and stages, and seconds of wall, of all jobs and of all stages."""

    jobs: int
    stages: int
    wall: float
    in_jobs: float
    in_stages: float

    @property
    def overhead(self) -> float:
        """Seconds of a job that are none of its stages'."""
        return (self.in_jobs - self.in_stages) / self.jobs

    def __str__(self) -> str:
        shares = f"{self.wall:.1f} s of wall, {self.in_jobs:.0f} s in jobs, {self.in_stages:.1f} s in stages"
        return f"{self.stages} stages in {self.jobs} jobs: {shares}, overhead {self.overhead:.2f} s a job"


def cost(folder: Path, experiment: str, *arguments: str) -> Cost:
    """Run an experiment through Slurm."""
    stages, began = set(folder.glob("there/logs/*/*.benchmark.tsv")), time.time()
    run(folder, experiment, "results=there", "profile=profiles/slurm", *arguments)
    wall = time.time() - began
    stages = set(folder.glob("there/logs/*/*.benchmark.tsv")) - stages
    spans = [line.split() for line in said("squeue", "--noheader", "--states=all", "--format=%S %e").splitlines()]
    times = [[datetime.fromisoformat(text).timestamp() for text in span] for span in spans]
    times = [span for span in times if span[0] >= began - 1.0]
    seconds = sum(float(file.read_text().splitlines()[1].split("\t")[0]) for file in stages)
    return Cost(len(times), len(stages), wall, sum(end - start for start, end in times), seconds)


def test_quickstart_gives_the_same_bytes(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(folder, "quickstart", "results=here")
    taken = cost(folder, "quickstart")
    here = bytes_of(folder / "here")
    assert len(here) == 2 * taken.stages and here == bytes_of(folder / "there")
    assert 10 <= taken.jobs < taken.stages  # surfaces, images and operators go together
    with capsys.disabled():
        print(f"\nquickstart: {taken}")


def test_a_sweep_of_five_hundred_travels_in_few_jobs(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    radii = [round(1.0 + 0.001 * number, 3) for number in range(500)]
    for name, chosen in (("first", radii[:10]), ("sweep", radii)):
        surface = {"name": "icosphere", "levels": 1}
        write(folder, name, json.dumps({"target": "surface", "surface": surface, "grid": {"surface.radius": chosen}}))
    first, sweep = cost(folder, "first"), cost(folder, "sweep")
    assert (first.jobs, first.stages) == (10, 10)  # of which nothing was known
    assert (sweep.jobs, sweep.stages) == (5, 490)
    run(folder, "sweep", "results=here")
    here = bytes_of(folder / "here")
    assert len(here) == 1000 and here == bytes_of(folder / "there")
    assert first.overhead < 20.0 and sweep.wall / sweep.stages < 0.5
    with capsys.disabled():
        print(f"\nalone: {first}\ntogether: {sweep}")


def test_plain_snakemake_takes_the_profile(folder: Path) -> None:
    surface = {"name": "icosphere", "levels": 1}
    write(folder, "sphere", json.dumps({"target": "operator", "surface": surface, "operator": "fem"}))
    asked = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile"), "--workflow-profile"]
    asked += [str(ROOT / "profiles" / "slurm"), "--config", "experiment=sphere", "results=there"]
    done = subprocess.run(asked, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr.count("has been submitted with SLURM jobid") == 1, done.stderr
    run(folder, "sphere", "results=here")
    assert len(bytes_of(folder / "here")) == 4 and bytes_of(folder / "there") == bytes_of(folder / "here")


def test_a_cancelled_job_is_named_and_the_same_command_continues(folder: Path) -> None:
    (folder / "plugins" / "surface").mkdir(parents=True)
    (folder / "plugins" / "surface" / "sleeping.py").write_text(SLEEPER)
    write(folder, "sleep", json.dumps({"target": "surface", "grid": {"surface": ["sleeping", "icosphere"]}}))
    with started(folder, "sleep") as going:
        wait_for(lambda: list(folder.glob("results/store/surface/*/record.json")))
        job = wait_for(lambda: only(said("squeue", "--noheader", "--states=RUNNING", "--format=%i").splitlines()))
        wait_for(lambda: list(folder.glob("results/events/surface/*.progress")))
        said("scancel", job)
        heard, _ = going.communicate(timeout=120)
    assert going.returncode == 1 and "Traceback" not in heard, heard
    (line,) = [line for line in heard.splitlines() if line.startswith("surfexp: ")]
    assert f"surface/sleeping: its job {job} in Slurm ended as CANCELLED; see /" in line
    (folder / "awake").touch()
    run(folder, "sleep", "profile=profiles/slurm")
    assert len(bytes_of(folder / "results")) == 4


@pytest.mark.timeout(120)  # where nothing is said it waits for ever
def test_a_node_that_is_drained_is_named_while_one_waits(folder: Path) -> None:
    node = said("sinfo", "--noheader", "--format=%n")
    said("scontrol", "update", f"nodename={node}", "state=drain", "reason=the disk is full")
    write(folder, "sphere", json.dumps({"target": "surface", "surface": "icosphere"}))
    with started(folder, "sphere") as going:
        try:
            assert going.stdout is not None
            warning = next(line for line in going.stdout if "waiting in Slurm's queue" in line)
        finally:
            said("scontrol", "update", f"nodename={node}", "state=resume")
        going.send_signal(signal.SIGINT)
        heard, _ = going.communicate(timeout=60)
    assert "surfexp: warning" in warning and f"({node}: the disk is full)" in warning
    assert going.returncode == 130, heard
    assert not said("squeue", "--noheader", "--states=PENDING,RUNNING", "--format=%i")
