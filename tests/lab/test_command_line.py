"""The command as a person uses it: exit codes, one-line errors, sharing, reruns, failures, interruption, tracking."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

TOYS = Path(__file__).with_name("toy_plugins.py")
LIMIT = 1800
ROOT = Path(__file__).resolve().parent.parent.parent
CHAIN = """# @package _global_
experiment: chain
target: pairing
title: A toy
surface: toy_triangle
scalar: toy_boundary
pairing:
  name: toy_distance
  inputs:
    source: {scalar: toy_eigenfunction, weighted: {name: toy_flux, inputs: {weight: {scalar: toy_boundary}}}}
    target: {scalar: {name: toy_boundary, shift: 1.0}}
"""

# limits are for what never ends: a busy machine takes many times as long
pytestmark = pytest.mark.timeout(3600)


def surfexp(*arguments: str, code: int = 0, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-P", "-m", "surfexp.commands.command_line", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, timeout=LIMIT)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    return done


def furnished(working_folder: Path) -> Path:
    (working_folder / "plugins" / "pairing").mkdir(parents=True)
    shutil.copy(TOYS, working_folder / "plugins" / "pairing" / "toys.py")
    (working_folder / "conf" / "experiment").mkdir(parents=True)
    (working_folder / "conf" / "experiment" / "chain.yaml").write_text(CHAIN)
    # what lies in the folder where somebody works is no module: no process may take it for one
    for name in ("numpy", "json", "mlflow", "snakemake", "surfexp"):
        (working_folder / f"{name}.py").write_text("raise ImportError('taken from the working folder')")
    return working_folder


@pytest.fixture
def laboratory(working_folder: Path) -> Path:
    """A working folder with an experiment and plugins of its own."""
    return furnished(working_folder)


@pytest.fixture(scope="module")
def untouched(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One laboratory for all questions that leave it as it is."""
    return furnished(tmp_path_factory.mktemp("untouched"))


@pytest.fixture
def asked(untouched: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The untouched laboratory, worked in."""
    monkeypatch.chdir(untouched)
    return untouched


def runs(folder: Path) -> dict[str, tuple[str, dict[str, str], dict[str, float]]]:
    from mlflow.tracking import MlflowClient

    client = MlflowClient(f"sqlite:///{folder / 'results' / 'mlflow.db'}")
    experiment = client.get_experiment_by_name("chain")
    assert experiment is not None
    found = client.search_runs([experiment.experiment_id])
    return {run.data.tags["leaf"]: (run.info.status, run.data.tags, run.data.metrics) for run in found}


def store_bytes(folder: Path) -> dict[str, bytes]:
    store = folder / "results" / "store"
    return {
        str(file.relative_to(store)): file.read_bytes() for file in store.rglob("*.*") if not file.name.startswith(".")
    }


def latest_log(folder: Path) -> str:
    logs = (folder / "results" / "logs").glob("*.snakemake.log")
    return max(logs, key=lambda path: path.stat().st_mtime).read_text()


def test_a_run_a_rerun_a_sweep_a_failure_and_its_mending(laboratory: Path) -> None:
    first = surfexp("run", "experiment=chain")
    assert "toy_distance" in first.stdout and "results/chain/report.html" in first.stdout
    assert {status for status, _, _ in runs(laboratory).values()} == {"FINISHED"} and len(runs(laboratory)) == 2
    before = store_bytes(laboratory)

    again = surfexp("run", "experiment=chain")
    assert "nothing to compute" in again.stdout and len(runs(laboratory)) == 2 and store_bytes(laboratory) == before
    nothing = subprocess.run(
        [sys.executable, "-P", "-m", "snakemake", "-n", "--snakefile", str(ROOT / "Snakefile"),
         "--config", "experiment=chain"],
        capture_output=True, text=True, timeout=LIMIT,
    )  # fmt: skip
    assert "Nothing to be done" in nothing.stdout + nothing.stderr, nothing.stdout + nothing.stderr

    damaged = next((laboratory / "results" / "store" / "surface").glob("*/arrays.npz"))
    damaged.write_bytes(damaged.read_bytes()[:-1])
    assert f"surface/{damaged.parent.name} is damaged: arrays.npz" in surfexp("run", "experiment=chain").stderr
    assert (
        latest_log(laboratory).count("localrule") == 2
    )  # the surface, nothing that was made from it, and the rule all
    assert store_bytes(laboratory) == before

    surfexp("run", "experiment=chain", "surface.size=2.0")
    assert len(runs(laboratory)) == 3
    planned = surfexp("plan", "experiment=chain", "surface.size=2.0,3.0,4.0").stdout
    assert "3 configurations: 24 stages without sharing, 18 with sharing" in planned
    surfexp("run", "experiment=chain", "surface.size=2.0,3.0,4.0")
    assert latest_log(laboratory).count("localrule") == 13  # the stages of two new sizes, and the rule all

    with (laboratory / "results" / "chain" / "metrics.csv").open() as file:
        one, other, *_ = [row["leaf"] for row in csv.DictReader(file)]
    told = surfexp("diff", one[:8], other[:8]).stdout
    assert "surface.size" in told and "distance" in told and one[:8] in told

    toys = laboratory / "plugins" / "pairing" / "toys.py"
    good = toys.read_text()
    toys.write_text(
        good.replace('raise ValueError(f"surface', 'x = ValueError(f"surface').replace(
            "value = float(np.abs(source.values - target.values).max())", 'raise ValueError("planted failure")'
        )
    )
    failed = surfexp("run", "experiment=chain", code=1)
    assert "pairing/toy_distance: planted failure" in failed.stderr and "Traceback" not in failed.stderr
    assert sorted(status for status, _, _ in runs(laboratory).values()).count("FAILED") == 2  # the leaf and its parent
    toys.write_text(good.replace("value = float(np.abs(", "value = 1.0 * float(np.abs("))
    surfexp("run", "experiment=chain")
    assert {status for status, _, _ in runs(laboratory).values()} == {"FINISHED"}  # the failed run was taken over
    assert len(runs(laboratory)) == 6
    assert (
        sum(tags.get("current") == "false" for _, tags, _ in runs(laboratory).values()) == 1
    )  # that of the older code


@pytest.mark.slow
def test_several_experiments_have_a_page_each_and_one_that_fails_stops_no_other(laboratory: Path) -> None:
    folder = laboratory / "conf" / "experiment"
    changes = {"second": ("shift: 1.0", "shift: 2.0"), "without_path": ("surface: toy_triangle", "surface: file")}
    for name, change in changes.items():
        (folder / f"{name}.yaml").write_text(CHAIN.replace("experiment: chain", f"experiment: {name}").replace(*change))
    done = surfexp("run", "experiment=chain,without_path,second", code=2)
    assert "surface/file.path is required; set surface.path=VALUE" in done.stderr and "Traceback" not in done.stderr
    assert "surfexp: 1 of 3 experiments did not end: without_path" in done.stderr
    for name in ("chain", "second"):
        page = (laboratory / "results" / name / "report.html").read_text()
        assert f"{name}: 1 configuration, " in done.stdout and "toy_distance" in page
    assert not (laboratory / "results" / "without_path").exists()
    planned = surfexp("plan", "experiment=chain,second").stdout
    assert "plan of chain" in planned and "plan of second" in planned and planned.count("0 to compute") == 2


@pytest.mark.slow
def test_plain_snakemake_is_tracked_and_gives_the_same_bytes(laboratory: Path) -> None:
    command = [
        sys.executable,
        "-P",
        "-m",
        "snakemake",
        "-c2",
        "--snakefile",
        str(ROOT / "Snakefile"),
        "--config",
        "experiment=chain",
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 0, done.stderr
    assert {status for status, _, _ in runs(laboratory).values()} == {"FINISHED"}
    assert (laboratory / "results" / "chain" / "report.html").exists()
    plain = store_bytes(laboratory)
    shutil.rmtree(laboratory / "results")
    surfexp("run", "experiment=chain")
    assert store_bytes(laboratory) == plain


@pytest.mark.parametrize(
    "victim",
    [
        pytest.param("surfexp.commands.command_line", marks=pytest.mark.slow),
        pytest.param("surfexp.lab.running.snakemake", marks=pytest.mark.slow),
        pytest.param("surfexp.lab.running.stage_server", marks=pytest.mark.slow),
    ],
)
def test_kill_in_the_middle_and_the_next_run_continues(laboratory: Path, victim: str) -> None:
    surfexp("run", "experiment=chain")
    undisturbed = store_bytes(laboratory)
    shutil.rmtree(laboratory / "results")
    command = [sys.executable, "-P", "-m", "surfexp.commands.command_line", "run", "experiment=chain"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + LIMIT
    while time.monotonic() < deadline and process.poll() is None:
        pattern = "surfexp.commands.command_line.*chain" if victim.endswith("line") else f"{victim}.*{laboratory}"
        pids = subprocess.run(["pgrep", "-f", pattern], capture_output=True, text=True).stdout.split()
        started = list((laboratory / "results" / "store").glob("*/*/record.json"))
        if pids and started:
            for pid in pids:
                if victim != "surfexp.commands.command_line" or int(pid) == process.pid:
                    try:
                        os.kill(int(pid), signal.SIGKILL)
                    except ProcessLookupError:
                        continue
            break
        time.sleep(0.02)
    process.wait(timeout=LIMIT)
    surfexp("run", "experiment=chain")
    assert store_bytes(laboratory) == undisturbed


@pytest.mark.slow
def test_two_runs_at_once_on_one_results_folder(laboratory: Path) -> None:
    command = [sys.executable, "-P", "-m", "surfexp.commands.command_line", "run", "experiment=chain"]
    both = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    outputs = [process.communicate(timeout=LIMIT) for process in both]
    assert [process.returncode for process in both] == [0, 0], outputs
    assert any("in use by another run" in error for _, error in outputs)
    assert len(runs(laboratory)) == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["rnu"], "unknown command 'rnu'; did you mean 'run'?"),
        (["run", "solver=primal_daul"], "unknown solver 'primal_daul'; did you mean 'primal_dual'?"),
        (["run", "--multrun", "solver=newton,threshold"], "unknown option '--multrun'; did you mean '--multirun'?"),
        (["run", "experiment=quickstrat"], "unknown experiment 'quickstrat'; did you mean 'quickstart'?"),
        (["run", "+nosuch=1"], "unknown configuration key 'nosuch'"),
        (
            ["run", "experiment=chain", "surface.size=-1"],
            "surface/toy_triangle.size = -1: Input should be greater than 0",
        ),
        (
            ["run", "experiment=chain", "surface.szie=1"],
            "unknown option of surface/toy_triangle 'szie'; did you mean 'size'?",
        ),
        (["run", "experiment=chain", "surface=file"], "surface/file.path is required; set surface.path=VALUE"),
        (["run", "experiment=chain", "surface=file", "surface.path=no.ply"], "file 'no.ply' does not exist"),
        (["info", "solver/primal_daul"], "did you mean 'primal_dual'?"),
        (["list", "solvers"], "unknown stage kind 'solvers'; did you mean 'solver'?"),
        (["table", "nothing"], "unknown finished experiment"),
        (["run", "results=/proc/none"], "/proc/none: No such file or directory; choose another results folder"),
    ],
)
def test_mistakes_end_with_code_2_and_one_line(asked: Path, arguments: list[str], message: str) -> None:
    done = surfexp(*arguments, code=2)
    assert message in done.stderr, done.stderr
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr


def test_a_broken_plugin_file_is_named_with_its_line_and_the_rest_works(laboratory: Path) -> None:
    (laboratory / "plugins" / "solver").mkdir()
    (laboratory / "plugins" / "solver" / "crooked.py").write_text("x = 1\ndef f(:\n")
    done = surfexp("list", "solver")
    assert "crooked.py, line 2" in done.stderr and "primal_dual" in done.stdout
    assert "crooked.py, line 2" in surfexp("run", "solver=crooked", code=2).stderr


@pytest.mark.slow
def test_two_plugins_of_one_name_are_refused_naming_both_files(laboratory: Path) -> None:
    (laboratory / "plugins" / "operator").mkdir()
    original = (ROOT / "plugins" / "operator" / "fem.py").read_text()
    (laboratory / "plugins" / "operator" / "fem.py").write_text(original)
    assert "fem" in surfexp("list", "operator").stdout  # the same path and content twice is one plugin
    (laboratory / "plugins" / "operator" / "fem.py").write_text(original + "\nOTHER = 1\n")
    error = surfexp("list", code=2).stderr
    assert "operator/fem is defined twice" in error and error.count("fem.py") == 2


def test_help_and_catalogue(asked: Path) -> None:
    for name in ("list", "info", "table", "report", "ui", "clean", "verify", "new", "view", "check", "doctor"):
        assert "Usage: surfexp" in surfexp(name, "--help").stdout
    assert "primal_dual" in surfexp("run", "--help").stdout and "toy_triangle" in surfexp("run", "--help").stdout
    listed = surfexp("info", "surface/toy_triangle").stdout
    assert "size" in listed and "> 0" in listed and "side length" in listed
    assert "chain" in surfexp("list", "experiment").stdout


@pytest.mark.slow
def test_a_new_plugin_is_listed(laboratory: Path) -> None:
    surfexp("new", "solver", "my_method")
    assert "my_method" in surfexp("list", "solver").stdout
    assert "exists" in surfexp("new", "solver", "my_method", code=2).stderr


@pytest.mark.slow
def test_clean_keeps_what_plans_name(laboratory: Path) -> None:
    surfexp("run", "experiment=chain")
    kept, plans = store_bytes(laboratory), {*(laboratory / "results" / "plans").iterdir()}
    surfexp("run", "experiment=chain", "surface.size=2.0")
    both = store_bytes(laboratory)
    surfexp("clean", "--older", "--yes")
    assert store_bytes(laboratory) == both != kept
    for plan in {*(laboratory / "results" / "plans").iterdir()} - plans:
        plan.unlink()
    surfexp("clean", "--yes")
    assert store_bytes(laboratory) == kept
    surfexp("clean", "--all", "--yes")
    assert not (laboratory / "results" / "store").exists()


@pytest.mark.parametrize("by", ["ctrl-c", pytest.param("kill", marks=pytest.mark.slow)])
def test_interruption_ends_with_130_and_keeps_what_is_done(laboratory: Path, by: str) -> None:
    command = [sys.executable, "-P", "-m", "surfexp.commands.command_line", "run", "experiment=chain"]
    # a test that itself runs in the background of a shell would hand on that Ctrl-C is ignored
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    deadline = time.monotonic() + LIMIT
    while not list(laboratory.glob("results/store/*/*/record.json")) and time.monotonic() < deadline:
        time.sleep(0.02)
    if by == "kill":
        os.kill(process.pid, signal.SIGTERM)
    else:
        os.killpg(process.pid, signal.SIGINT)
    _, error = process.communicate(timeout=LIMIT)
    assert process.returncode == 130 and "interrupted" in error and "Traceback" not in error, error
    surfexp("run", "experiment=chain")
    assert json.loads(next(laboratory.glob("results/store/pairing/*/record.json")).read_text())
