"""What follows `surfexp run` and `surfexp plan` does what users of Hydra expect."""

from __future__ import annotations

import copy
import logging
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from hydra._internal.utils import get_args_parser
from hydra.core.config_store import ConfigStore

from surfexp.commands.command_line import main
from surfexp.lab.composition.hydra_plugins import prepare_hydra
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.hydra_flags import FLAGS, WITH_VALUE, parted

OWN = """# @package _global_
experiment: own
title: Own
surface: {name: icosphere, levels: 2}
image: two_phase
operator: fem
model: rof
columns: [relative_gap]
claims: []
variants:
  - {comparison: A, solver: {name: primal_dual, tolerance: 1.0e-3}}
  - {comparison: A, solver: {name: newton, tolerance: 1.0e-5}}
"""


@pytest.fixture
def own(working_folder: Path) -> Path:
    """A working folder with an experiment, and another in a folder of configurations of its own."""
    for folder, text in (("conf", OWN), ("elsewhere", OWN.replace("experiment: own", "experiment: other"))):
        (working_folder / folder / "experiment").mkdir(parents=True)
        name = "own" if folder == "conf" else "other"
        (working_folder / folder / "experiment" / f"{name}.yaml").write_text(text)
    return working_folder


def told(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 0) -> str:
    capsys.readouterr()
    assert main(list(arguments)) == code, capsys.readouterr()
    said = capsys.readouterr()
    if code:
        assert said.err.count("\n") == 1 and len(said.err) <= 400, said.err
    return said.err if code else said.out


def rows(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    """Numbers of configurations of each plan that is shown."""
    said = told(capsys, "plan", "experiment=own", *arguments)
    return [line.partition(" ")[0] for line in said.splitlines() if re.search(" configurations?: ", line)]


def test_flags_and_their_values_are_those_of_hydra() -> None:
    actions = [action for action in get_args_parser()._actions if action.option_strings]
    assert {name for action in actions for name in action.option_strings} == set(FLAGS)
    for action in actions:
        flag = FLAGS[action.option_strings[0]]
        assert (flag in WITH_VALUE) == (action.nargs != 0), flag
        assert WITH_VALUE.get(flag, ()) == tuple(action.choices or ()), flag


@pytest.mark.parametrize(
    ("words", "flags", "overrides"),
    [
        (["a=1", "--cfg", "job", "b=2"], {"--cfg": "job"}, ("a=1", "b=2")),
        (["-c", "job", "--resolve"], {"--cfg": "job", "--resolve": ""}, ()),
        (["--cfg=all", "a=1"], {"--cfg": "all"}, ("a=1",)),
        (["--info", "a=1"], {"--info": ""}, ("a=1",)),
        (["-i", "plugins", "a=1"], {"--info": "plugins"}, ("a=1",)),
        (["-m", "~a"], {"--multirun": ""}, ("~a",)),
    ],
)
def test_flags_are_parted_from_overrides(words: list[str], flags: dict[str, str], overrides: tuple[str, ...]) -> None:
    found = parted(words)
    assert (dict(found.flags), found.overrides) == (flags, overrides)
    assert sorted([*found.typed, *found.overrides]) == sorted(words), "a word was lost"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--multrun"], "did you mean '--multirun'"),
        (["--cfg"], "--cfg needs a value: job, hydra, all"),
        (["--cfg", "jbo"], "did you mean 'job'"),
        (["--multirun=1"], "--multirun has no value"),
        (["--resolve"], "give --cfg job"),
        (["--run", "-m"], "exclude each other"),
        (["--config-dir", "nowhere"], "no such folder"),
    ],
)
def test_flags_that_are_wrong_are_refused(words: list[str], said: str) -> None:
    with pytest.raises(UserError, match=said):
        parted(words)


def test_cfg_shows_what_the_command_line_makes_of_the_experiment(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shown = yaml.safe_load(told(capsys, "run", "experiment=own", "surface.levels=4", "~columns", "--cfg", "job"))
    assert shown["experiment"] == "own" and "hydra" not in shown and "columns" not in shown
    assert "4" in str(shown["surface"]) and "2" not in str(shown["surface"])
    part = told(capsys, "plan", "experiment=own", "solver=newton", "--cfg", "job", "--package", "solver")
    assert part.startswith("# @package solver\n") and yaml.safe_load(part)["name"] == "newton"
    assert "subdir" in told(capsys, "run", "--cfg", "hydra", "--package", "hydra.sweep")
    assert "x/plans" in told(capsys, "run", "results=x", "--cfg", "hydra", "--package", "hydra.sweep", "--resolve")
    assert set(yaml.safe_load(told(capsys, "run", "experiment=own", "--cfg", "all"))) >= {"hydra", "title", "variants"}
    assert not Path("results").exists(), "nothing was run"
    assert "one job" in told(capsys, "run", "solver=newton,primal_dual", "--cfg", "job", code=2)
    assert "no nosuch" in told(capsys, "run", "--cfg", "job", "--package", "nosuch", code=2)


@pytest.fixture
def log_as_before() -> Iterator[None]:
    """The log of the process, which --info leaves on, writing to a terminal that is captured no more."""
    root = logging.getLogger()
    handlers, level = list(root.handlers), root.level
    hydra = logging.getLogger("hydra")
    of_hydra = list(hydra.handlers), hydra.level
    yield
    root.handlers[:], hydra.handlers[:] = handlers, of_hydra[0]
    root.setLevel(level)
    hydra.setLevel(of_hydra[1])


@pytest.mark.usefixtures("log_as_before")
def test_info_and_version_are_hydras(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "Hydra" in told(capsys, "run", "--info", "plugins", "experiment=own")
    assert "elsewhere" in told(capsys, "run", "--config-dir", "elsewhere", "--info", "searchpath")
    assert told(capsys, "run", "--version").splitlines()[-1].startswith("Hydra ")  # --info leaves its log on


@pytest.mark.slow
def test_the_help_of_hydra_lists_its_flags(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "== Flags ==" in told(capsys, "run", "--hydra-help")


def test_a_folder_of_configurations_is_added(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "unknown experiment 'other'" in told(capsys, "plan", "experiment=other", code=2)
    for flag in (["--config-dir", "elsewhere"], ["-cd", "elsewhere"], ["--config-dir=elsewhere"]):
        assert "plan of other" in told(capsys, "plan", *flag, "experiment=other")
    swept = told(capsys, "plan", "--config-dir", "elsewhere", "experiment=other", "surface.levels=2,3")
    assert "plan of other" in swept and "4 configurations" in swept


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], ["2"]),
        (["-m"], ["2"]),
        (["--run"], ["2"]),
        (["--multirun", "surface.levels=2,3"], ["4"]),
        (["surface.levels=2,3"], ["4"]),
        (["~columns"], ["2"]),
        (["~columns", "surface.levels=2,3"], ["4"]),
        (["~surface.levels"], ["2"]),
        (["~surface.levels=2"], ["2"]),
        (["~solver.tolerance"], ["2"]),
        (["~variants", "solver=primal_dual"], ["1"]),
        (["figure=null"], ["2"]),
        (["+solver=newton"], ["1"]),
        (["++solver.tolerance=1e-2"], ["2"]),
        (["hydra/sweeper=basic"], ["2"]),
        (["hydra.job.name=x"], ["2"]),
        (["hydra/launcher=basic", "surface.levels=2,3"], ["2", "2"]),
        (["hydra/launcher=basic", "hydra/sweeper=basic"], ["2"]),
        (["-cn", "config"], ["2"]),
    ],
)
def test_what_hydra_is_told_is_planned(
    own: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], expected: list[str]
) -> None:
    assert rows(capsys, *arguments) == expected


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["hydra/launcher=nosuch"], "Could not find 'hydra/launcher/nosuch'"),
        (["hydra/sweeper=nosuch"], "Could not find 'hydra/sweeper/nosuch'"),
        (["~grid"], "~grid: the experiment sets no grid; it sets: claims, columns, "),
        (["~nosuch"], "unknown configuration key 'nosuch'"),
        (["~surface.levels=5"], "~surface.levels=5: it is 2; leave the value out"),
        (["~surface.szie"], "unknown option of surface/icosphere 'szie'"),
        (["~surface"], "no surface is configured"),
        (["solver.n=3"], "unknown option of solver 'n'"),
        (["distance.n=3"], "distance.n: the experiment chooses no distance; add distance=NAME"),
        (["solver"], "'solver' sets nothing: write KEY=VALUE"),
        (["job"], "'job' sets nothing: write KEY=VALUE"),
        (["surface=file", "surface.path=a(1).ply"], "inside quotes for the shell: 'surface.path=\"a(1).ply\"'"),
        (["title=it's"], "quotes for the shell: "),
    ],
)
def test_what_hydra_cannot_do_is_one_line(
    own: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], said: str
) -> None:
    assert said in told(capsys, "plan", "experiment=own", *arguments, code=2)


def test_the_way_that_a_quoted_value_is_shown_can_be_typed(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for value in ("a(1).ply", "a=b,c.off", "ue [x] {1}.off", "it's.ply", 'say "x"(.ply', "back\\slash(.ply"):
        error = told(capsys, "plan", "experiment=own", "surface=file", f"surface.path={value}", code=2)
        (word,) = shlex.split(error.partition("for the shell: ")[2])
        assert "does not exist" in (again := told(capsys, "plan", "experiment=own", "surface=file", word, code=2))
        assert repr(value) in again


def test_what_is_removed_is_not_computed_with(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """An option that is removed has its default: the plan is that of the experiment without it."""
    from surfexp.commands.request import plan_and_act

    (removed,) = plan_and_act(["experiment=own", "~surface.levels"], lambda plan: None)
    file = own / "conf" / "experiment" / "own.yaml"
    file.write_text(OWN.replace("surface: {name: icosphere, levels: 2}", "surface: icosphere"))
    (default,) = plan_and_act(["experiment=own"], lambda plan: None)
    file.write_text(OWN)
    (whole,) = plan_and_act(["experiment=own"], lambda plan: None)
    keys = [{leaf.key for leaf in plan.leaves} for plan in (removed, default, whole)]
    assert keys[0] == keys[1] and not keys[0] & keys[2]


def test_what_plugins_publish_is_not_copied_whole_and_stays_as_it_is() -> None:
    prepare_hydra()
    published = ConfigStore.instance()
    assert copy.deepcopy({"store": published})["store"] is published
    published.load("solver/primal_dual.yaml").node["tolerance"] = "changed"
    assert published.load("solver/primal_dual.yaml").node["tolerance"] != "changed"


@pytest.mark.parametrize(
    ("file", "asked"),
    [
        ("experiment/own.yaml", ["experiment=own"]),
        ("experiment/own.yaml", ["experiment=own", "surface.levels=2,3"]),
        ("experiment/own.yaml", ["experiment=own", "--cfg", "job"]),
        ("surface/ball.yaml", ["experiment=own", "surface=ball"]),
        ("datasets/balls.yaml", ["experiment=own", "datasets.surface=balls"]),
    ],
)
def test_of_two_files_of_one_name_none_is_taken(
    file: str, asked: list[str], own: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = own / "conf" / file, own / "elsewhere" / file
    for one in (first, second):
        one.parent.mkdir(exist_ok=True)
    first.write_text(OWN if "own" in file else "name: icosphere\n")
    second.write_text(f"# another\n{first.read_text()}")
    said = told(capsys, "plan", "--config-dir", "elsewhere", *asked, code=2)
    assert f"{file.removesuffix('.yaml')} is two files" in said and str(second) in said
    second.write_text(first.read_text())
    if "datasets" not in file:
        told(capsys, "plan", "--config-dir", "elsewhere", *asked)


def test_an_experiment_of_the_name_of_a_shipped_one_is_refused(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (own / "conf" / "experiment" / "rof_cup.yaml").write_text(OWN)
    assert "experiment/rof_cup is two files" in told(capsys, "plan", "experiment=rof_cup", code=2)
