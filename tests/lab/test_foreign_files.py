"""What others send is data: results, plans and experiments name files and classes, and nothing of theirs runs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import surfexp as sx
from surfexp.commands import execution
from surfexp.commands.command_line import main
from surfexp.lab.composition import launch
from surfexp.lab.composition.hydra_guard import refuse_code
from surfexp.lab.errors import DamagedResult, UserError
from surfexp.lab.experiment.configuration import settings_of
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import result_tree

RAN = "import pathlib; pathlib.Path(r'{}').touch()\n"


@pytest.fixture
def evil(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A module in the working folder that leaves a file when it is imported; the name of that file."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "evil.py").write_text(
        RAN.format(tmp_path / "ran") + "from dataclasses import dataclass\n@dataclass\nclass X: pass\n"
    )
    return tmp_path / "ran"


def test_a_stored_class_of_a_foreign_package_is_not_imported(evil: Path) -> None:
    with pytest.raises(DamagedResult, match=r"evil:X.*not imported"):
        result_tree.decoded({"class": "evil:X", "fields": {}}, {})
    assert not evil.exists()
    with pytest.raises(DamagedResult, match="is not a dataclass"):
        result_tree.decoded({"class": "surfexp.lab.store.store:save", "fields": {}}, {})


def test_a_plan_of_others_loads_no_file_that_it_names(evil: Path, tmp_path: Path) -> None:
    node = {"key": "0" * 20, "kind": "surface", "plugin": "of_others", "file": str(tmp_path / "evil.py")}
    node |= {"code": "", "cache": "", "options": {}, "inputs": {}}
    tree = {"settings": {"experiment": "sent"}, "nodes": {node["key"]: node}, "leaves": [], "requested": 0}
    (tmp_path / "results" / "plans").mkdir(parents=True)
    (tmp_path / "results" / "plans" / "sent-0.json").write_text(json.dumps(tree))
    assert len(sx.load("sent", results=tmp_path / "results").table) == 0
    assert not evil.exists()


HOSTILE = {
    "callbacks": "hydra:\n  callbacks:\n    mine: {_target_: evil.X}\n",
    "job_logging.handlers": "hydra:\n  job_logging:\n    handlers: {mine: {class: evil.X}}\n",
    "sweeper._target_": "hydra:\n  sweeper: {_target_: evil.X}\n",
    "launcher._target_": "hydra:\n  launcher: {_target_: evil.X}\n",
    "run.dir": "hydra:\n  run: {dir: ../elsewhere}\n",
    "sweep.dir": "hydra:\n  sweep: {dir: /tmp/elsewhere}\n",
    "job.env_set": "hydra:\n  job: {env_set: {PATH: here}}\n",
}


@pytest.mark.parametrize("setting", HOSTILE)
@pytest.mark.parametrize("sweep", [False, True])
def test_an_experiment_makes_hydra_run_nothing(evil: Path, tmp_path: Path, setting: str, sweep: bool) -> None:
    folder = tmp_path / "conf" / "experiment"
    folder.mkdir(parents=True)
    begin = "# @package _global_\nexperiment: sent\nsurface: disk\ntarget: surface\n"
    (folder / "sent.yaml").write_text(begin + HOSTILE[setting])
    acted: list[Plan] = []
    with pytest.raises(UserError, match=rf"sets hydra\.{setting}.*remove it") as raised:
        launch.launch(["experiment=sent", *(["surface.rings=3,4"] if sweep else [])], acted.append)
    assert len(str(raised.value).splitlines()) == 1
    assert not acted and not evil.exists()


def test_what_hydra_has_of_itself_and_a_search_are_let_through() -> None:
    basic = {"sweeper": {"_target_": "hydra._internal.core_plugins.basic_sweeper.BasicSweeper"}}
    folders = {
        "run": {"dir": "outputs/${now:%Y-%m-%d}/${now:%H-%M-%S}"},
        "sweep": {"dir": "${results}/plans", "subdir": "."},
    }
    sampler = {"_target_": "optuna.samplers.TPESampler", "seed": 1}
    optuna = {
        "sweeper": {"_target_": "hydra_plugins.hydra_optuna_sweeper.optuna_sweeper.OptunaSweeper", "sampler": sampler}
    }
    refuse_code(folders | basic)
    refuse_code(folders | optuna)
    optuna["sweeper"]["sampler"] = {"_target_": "evil.X"}
    with pytest.raises(UserError, match=r"sweeper\.sampler\._target_"):
        refuse_code(folders | optuna)


@pytest.mark.parametrize("name", ["../victim", "/srv/x", "a/b", "", ".hidden", "a b", "$(x)", "-x", "x" * 101])
def test_the_name_of_an_experiment_is_no_path(name: str) -> None:
    with pytest.raises(UserError, match="experiment"):
        settings_of({"experiment": name})


def test_cleaning_leaves_what_no_run_made(tmp_path: Path) -> None:
    mine = ["thesis.tex", "logs/diary.txt", "cache/own.bin", "quickstart/report.html", "figures/one.png"]
    made = ["store/surface/0/record.json", "plans/tiny-0.json", "logs/surface/0.log", "events/surface/0.json",
            "cache/verified.json", "tiny/report.html", "mlflow.db"]  # fmt: skip
    for name in mine + made:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("{}")
    assert main(["clean", "--all", "--yes", "--results", str(tmp_path)]) == 0
    left = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert left - {".lock"} == set(mine)


def test_a_profile_is_found_from_anywhere_or_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert (execution._profile("profiles/slurm") / "config.yaml").is_file()
    assert execution._profile("slurm") == execution._profile("profiles/slurm")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "config.v8+.yaml").write_text("cores: 1\n")
    assert execution._profile("mine") == (tmp_path / "mine").resolve()
    for name in ("profiles/slrum", "elsewhere/slurm", str(tmp_path)):
        with pytest.raises(UserError, match="unknown profile"):
            execution._profile(name)
    (tmp_path / "__pycache__").mkdir()
    monkeypatch.setattr(execution, "package_folder", lambda _: tmp_path)
    with pytest.raises(UserError, match=r"choose from: profiles/mine$"):
        execution._profile("zzz")
