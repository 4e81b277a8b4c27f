"""An experiment by Snakemake's own commands, in a folder that `surfexp init` has furnished."""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hydra.core.override_parser.types import QuotedString

from surfexp.commands import plain_snakemake, results_lock
from surfexp.commands.command_line import main
from surfexp.lab.composition.overrides import parsed
from surfexp.lab.errors import UserError

TOYS = Path(__file__).resolve().parents[1] / "lab" / "toy_plugins.py"
CHAIN = """# @package _global_
experiment: chain
target: pairing
surface: toy_triangle
scalar: toy_boundary
figures: []
pairing:
  name: toy_distance
  inputs:
    source: {scalar: toy_eigenfunction, weighted: {name: toy_flux, inputs: {weight: {scalar: toy_boundary}}}}
    target: {scalar: {name: toy_boundary, shift: 1.0}}
"""
OTHER = CHAIN.replace("shift: 1.0", "shift: 2.0").replace("chain", "other")
MODULE = """
rule all:
    input:
        "numbers.txt",


module surfexp:
    snakefile:
        "RULES"
    config:
        {"experiment": "chain", "surface": {"size": 2.0}}


use rule * from surfexp as surfexp_*


rule numbers:
    input:
        rules.surfexp_report.output.table,
    output:
        "numbers.txt",
    shell:
        "wc -l < {input} > {output}"
"""
NOTHING = "Nothing to be done"
EDGE = re.compile(r"(\d+) -> (\d+)")


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which two experiments that share stages have run."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "plugins" / "pairing").mkdir(parents=True)
    shutil.copy(TOYS, folder / "plugins" / "pairing" / "toys.py")
    (folder / "conf" / "experiment").mkdir(parents=True)
    (folder / "conf" / "experiment" / "chain.yaml").write_text(CHAIN)
    (folder / "conf" / "experiment" / "other.yaml").write_text(OTHER)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        assert main(["init", "chain"]) == 0
        shutil.rmtree(folder / "profiles")  # Snakemake is asked as anybody would ask it
        said = snakemake("-c2")
        assert "7 of 7 steps" in said or "(100%) done" in said, said
    return folder


@pytest.fixture
def folder(finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The same folder for each test as it was, with the times of its files."""
    shutil.copytree(finished, tmp_path / "kept", copy_function=shutil.copy2)
    monkeypatch.chdir(finished)
    yield finished
    monkeypatch.chdir(tmp_path)
    shutil.rmtree(finished)
    shutil.copytree(tmp_path / "kept", finished, copy_function=shutil.copy2)


def snakemake(*arguments: str, code: int = 0, **environment: str) -> str:
    command = [sys.executable, "-P", "-m", "snakemake", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, timeout=600)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def jobs(said: str) -> dict[str, int]:
    """Jobs that a dry run announces, by rule."""
    table = said.rpartition("Job stats:")[2].partition("\n\n")[0]
    found = (line.split() for line in table.splitlines())
    return {line[0]: int(line[1]) for line in found if len(line) == 2 and line[1].isdigit() and line[0] != "total"}


def edges(said: str) -> set[tuple[str, str]]:
    names = dict(re.findall(r'(\d+)\[label = "(\w+)"', said))
    return {(names[one], names[other]) for one, other in EDGE.findall(said)}


GRAPH = {
    ("surface", "scalar"),
    ("surface", "weighted"),
    ("scalar", "weighted"),
    ("weighted", "scalar"),
    ("scalar", "pairing"),
    *((kind, "report") for kind in ("surface", "scalar", "weighted", "pairing")),
    *((kind, "all") for kind in ("surface", "scalar", "weighted", "pairing", "report")),
}


def test_a_finished_run_is_finished_by_every_command_of_snakemake(folder: Path) -> None:
    assert (folder / "results" / "chain" / "report.html").exists()
    assert NOTHING in snakemake("-n") and NOTHING in snakemake("-c2")
    assert edges(snakemake("--rulegraph")) == GRAPH
    summary = [line.split("\t") for line in snakemake("--summary").splitlines() if line.startswith("results/")]
    assert len(summary) == 6 + 3 and {line[-1] for line in summary} == {"no update"}
    snakemake("--report", "snakemake.html")
    assert "results/chain/metrics.csv" in (folder / "snakemake.html").read_text()
    assert NOTHING in snakemake("-n", "--rerun-incomplete")
    assert NOTHING in snakemake("-n", "results/chain/metrics.csv")


@pytest.mark.slow
def test_another_experiment_and_surfexp_itself_leave_it_finished(folder: Path) -> None:
    """Their plans are other files, and so is the state of code that each stage is given."""
    assert jobs(snakemake("-n", "--config", "experiment=other")) == {"scalar": 1, "pairing": 1, "report": 1, "all": 1}
    snakemake("-c2", "--config", "experiment=other")
    assert NOTHING in snakemake("-n") and NOTHING in snakemake("-n", "--config", "experiment=other")
    command = [sys.executable, "-P", "-m", "surfexp.commands.command_line", "run", "experiment=chain"]
    subprocess.run([*command, "surface.size=3.0"], check=True, capture_output=True)
    # Snakemake knows the inputs of its own last report only: no stage runs, the page may
    assert set(jobs(snakemake("-n", "--config", "experiment=chain", "surface={size: 3.0}"))) <= {"report", "all"}
    assert jobs(snakemake("-n")) == {"report": 1, "all": 1}  # for the page is that of the other size
    snakemake("-c1")
    assert NOTHING in snakemake("-n")


@pytest.mark.slow
def test_a_result_that_is_lost_or_damaged_is_made_again_with_what_it_needs(folder: Path) -> None:
    before = {file: file.read_bytes() for file in folder.glob("results/store/*/*/*")}
    (surface,) = folder.glob("results/store/surface/*")
    shutil.rmtree(surface)
    # to Snakemake an input that was missing is a reason to run, whatever its age
    assert jobs(snakemake("-n")) == {"surface": 1, "scalar": 2, "weighted": 1, "report": 1, "all": 1}
    arrays = next(folder.glob("results/store/weighted/*/arrays.npz"))
    arrays.write_bytes(arrays.read_bytes()[:-1])
    said = snakemake("-c2")
    assert f"weighted/{arrays.parent.name} is damaged" in said and "it is removed and computed again" in said
    assert {file: file.read_bytes() for file in folder.glob("results/store/*/*/*")} == before
    assert NOTHING in snakemake("-n")
    assert jobs(snakemake("-n", "--forcerun", "weighted")) == {"weighted": 1, "report": 1, "all": 1}
    snakemake("-c2", "--forcerun", "weighted")
    assert {file: file.read_bytes() for file in folder.glob("results/store/*/*/*")} == before
    assert NOTHING in snakemake("-n")
    assert jobs(snakemake("-n", "--forceall"))["scalar"] == 3


def test_the_executor_with_warm_processes_gives_the_same_bytes(folder: Path) -> None:
    before = {file: file.read_bytes() for file in folder.glob("results/store/*/*/*")}
    shutil.rmtree(folder / "results")
    command = [sys.executable, "-P", "-m", "surfexp.lab.running.snakemake", str(os.getpid())]
    done = subprocess.run([*command, "-c2", "--executor", "surfexp"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert {file: file.read_bytes() for file in folder.glob("results/store/*/*/*")} == before
    assert (folder / "results" / "chain" / "report.html").exists() and NOTHING in snakemake("-n")


@pytest.mark.slow
def test_the_rules_are_a_module_of_another_workflow(folder: Path) -> None:
    (folder / "Snakefile").write_text(MODULE.replace("RULES", plain_snakemake.SNAKEFILE))
    assert ("surfexp_report", "numbers") in edges(snakemake("--rulegraph"))
    snakemake("-c2")
    with (folder / "results" / "chain" / "metrics.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert row["surface.size"] == "2.0" and (folder / "numbers.txt").read_text().strip() == "2"
    assert NOTHING in snakemake("-n")


def test_a_mistake_is_one_line(folder: Path) -> None:
    said = snakemake("-n", "--config", "experiment=chian", code=1)
    assert "unknown experiment 'chian'; did you mean 'chain'?" in said and "Traceback" not in said
    said = snakemake("-n", "--config", "experiment=chain", "surface={sise: 2}", code=1)
    assert "'sise'; did you mean 'size'?" in said
    (folder / "Snakefile").write_text(f'include: "{plain_snakemake.STAGES}"\n')
    assert "Snakefile is of an earlier version: remove it, then `surfexp init`" in snakemake("-n", code=1)


def test_a_missing_sbatch_is_said_at_once(folder: Path) -> None:
    pytest.importorskip("snakemake_executor_plugin_slurm")
    for name in ("bash", "sh", "which"):
        (folder / name).symlink_to(str(shutil.which(name)))
    said = snakemake("--executor", "slurm", "--jobs", "2", "--forceall", code=1, PATH=str(folder))
    assert "sbatch and squeue cannot be found here" in said and "Submitted" not in said


def test_nothing_is_removed_while_another_run_works_in_the_folder(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pairing = next(folder.glob("results/store/pairing/*"))
    (pairing / "record.json").unlink()
    half = pairing / ".arrays.elsewhere.npz"
    half.write_bytes(b"half")
    monkeypatch.setattr(results_lock, "locks", [])
    monkeypatch.delenv(results_lock.HELD, raising=False)
    results_lock.hold_results(folder / "results")
    assert "is in use by another run" in snakemake("-n") and half.exists()
    assert "is in use by another run" in snakemake("-c1", code=1) and half.exists()
    for descriptor in results_lock.locks:
        os.close(descriptor)
    snakemake("-n")
    assert not half.exists()


def test_init_keeps_what_is_there(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("config.yaml").write_text("experiment: rof_cup\n")
    assert main(["init"]) == 0
    assert (
        Path("config.yaml").read_text() == "experiment: rof_cup\n" and "kept:    config.yaml" in capsys.readouterr().out
    )
    assert main(["init"]) == 0
    Path("Snakefile").write_text("rule all:\n")
    assert main(["init"]) == 2 and "exists and is another one" in capsys.readouterr().err
    assert main(["init", "rof_cpu"]) == 2 and "did you mean 'rof_cup'?" in capsys.readouterr().err


def test_a_configuration_is_words_of_surfexp_run() -> None:
    config = {
        "experiment": "rof_cup",
        "solver": {"name": "newton", "tolerance": 1e-6},
        "columns": ["rmse"],
        "cores": None,
    }
    words = ["experiment=rof_cup", "solver=newton", "solver.tolerance=1e-06", 'columns=["rmse"]', "cores=null"]
    assert list(plain_snakemake.words_of(config)) == words


@pytest.mark.parametrize(
    "value",
    [
        [{"title": "both", "grid": {"surface.levels": [2, 3]}, "solver": {"name": "newton"}}, {}],
        ["größe", 'a "word"', "back\\slash", "at the end\\", '\\"', "a, b: {c} [d]", ""],
        [1, 2.5e-06, True, None, -3],
    ],
)
def test_lists_of_a_configuration_come_back_from_hydra(value: list[object]) -> None:
    (word,) = plain_snakemake.words_of({"variants": value})
    (read,) = parsed([word])
    assert _plain(read.value()) == value


def _plain(value: Any) -> Any:
    """What Hydra reads, quoted text as text."""
    if isinstance(value, QuotedString):
        return value.text
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list) else value


def test_a_plan_of_several_searches_is_refused(working_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plain_snakemake, "check_arguments", lambda arguments: None)
    monkeypatch.setattr(plain_snakemake, "plan_and_act", lambda arguments, action: [])
    with pytest.raises(UserError, match="a search is run by surfexp run"):
        plain_snakemake._plan_of(["experiment=rof_cup"])


def test_a_stage_is_spelled_as_in_an_experiment() -> None:
    config = {"experiment": "rof_cup", "surface": {"name": "icosphere", "levels": 3}, "operator": "fem"}
    words = ["experiment=rof_cup", "surface=icosphere", "surface.levels=3", "operator=fem"]
    assert list(plain_snakemake.words_of(config)) == words
