"""`surfexp check` of an experiment, its line for each mistake; `surfexp new experiment`; the schema for editors."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import jsonschema
import pytest
import yaml

from surfexp.commands.command_line import main
from surfexp.lab.experiment.lines import with_line
from surfexp.lab.registry.folders import experiments

GOOD = """\
title: Does the error grow with the noise?
surface: {name: icosphere, levels: 3}
image: {name: two_phase}
model: rof
solver: primal_dual
grid: {image.noise: [10.0, 20.0], operator: [fem, libigl]}
repeat: {image.seed: 3}
figures: [{name: sweep, metric: rmse, against: image.noise}]
claims:
  - claim: Twice the noise gives at most thrice the error
    quantity: {ratio: rmse}
    rows: [{image.noise: 20.0}, {image.noise: 10.0}]
    between: [0, 3]
"""
# what is changed, into what, the line of the mistake, what is said of it
MISTAKES = [
    ("name: icosphere", "name: icosfere", 2, "did you mean 'icosphere'"),
    ("levels: 3", "level: 3", 2, "did you mean 'levels'"),
    ("levels: 3", "levels: -3", 2, "greater than or equal to"),
    ("solver:", "solvr:", 5, "did you mean 'solver'"),
    ("solver: primal_dual", "measurement: energy_excess", 5, "is called 'statistic' now"),
    ("repeat:", "target: measurement\nrepeat:", 7, "is called 'statistic' now"),
    ("libigl", "libigll", 6, "did you mean 'libigl'"),
    ("image.seed: 3", "image.seed: 0", 7, "number of repetitions"),
    ("against: image.noise", "against: image.nois", 8, "did you mean 'image.noise'"),
    ("metric: rmse", "metric: rmsee", 8, "did you mean 'rmse'"),
    ("ratio:", "rato:", 11, "did you mean 'ratio'"),
    ("ratio: rmse", "ratio: rmsee", 11, "did you mean 'rmse'"),
    ("[0, 3]", "[3, 0]", 10, "above the upper end"),
    ("  - claim", "\t- claim", 10, "cannot start any token"),
    ("model: rof\n", "model: rof\nmodel: tv\n", 5, "stands there twice"),
]


@pytest.fixture
def file(working_folder: Path) -> Iterator[Path]:
    file = working_folder / "conf" / "experiment" / "mine.yaml"
    file.parent.mkdir(parents=True)
    file.write_text(GOOD)
    yield file


def test_a_good_file_is_planned_and_counted(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "conf/experiment/mine.yaml"]) == 0
    assert "nothing wrong; 12 rows, " in capsys.readouterr().out
    assert not (file.parents[2] / "results").exists()


@pytest.mark.parametrize(("old", "new", "line", "said"), MISTAKES, ids=[new for _, new, _, _ in MISTAKES])
def test_a_mistake_is_told_with_its_line(
    file: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, line: int, said: str
) -> None:
    file.write_text(GOOD.replace(old, new, 1))
    assert main(["check", "conf/experiment/mine.yaml"]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and len(error) <= 301
    assert f"conf/experiment/mine.yaml, line {line}: " in error and said in error


def test_a_file_elsewhere_is_refused(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file.rename(file.parents[2] / "mine.yaml")
    assert main(["check", "mine.yaml"]) == 2 and "a folder conf/experiment, of yours" in capsys.readouterr().err
    assert main(["check", "other.yaml"]) == 2 and "no such file" in capsys.readouterr().err


def test_what_the_command_line_says_is_not_looked_for_in_the_file(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", "experiment=mine", "solver=rof"]) == 2
    assert "line" not in capsys.readouterr().err


def test_lines_of_keys_values_and_dotted_names(tmp_path: Path) -> None:
    file = tmp_path / "e.yaml"
    file.write_text("a: x\nb: &b {long.name: [y]}\nc: *b\nd: A statement that is long enough for a table\n")
    assert with_line("unknown thing 'y'", file) == f"{file}, line 2: unknown thing 'y'"
    assert with_line("kind/plugin.name = 3: too large", file).startswith(f"{file}, line 2: ")
    assert with_line("claim 1 (A statement that is long)", file).startswith(f"{file}, line 4: ")
    assert with_line("unknown thing 'z'", file) == "unknown thing 'z'"


def test_a_new_experiment_can_be_run(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "experiment", "noise_race"]) == 0
    assert main(["check", "conf/experiment/noise_race.yaml"]) == 0
    assert "18 rows" in capsys.readouterr().out
    assert main(["new", "experiment", "noise_race"]) == 2 and "exists" in capsys.readouterr().err
    assert main(["new", "experiment", "../up"]) == 2 and "letters" in capsys.readouterr().err
    assert not (working_folder.parent / "up.yaml").exists()


def test_the_schema_takes_every_experiment_and_no_mistake(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", "--to", "schema.json"]) == 0
    assert "yaml-language-server" in capsys.readouterr().out
    schema = json.loads(Path("schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    for known in experiments().values():
        document = yaml.safe_load(known.read_text(encoding="utf-8"))
        assert validator.is_valid(document), f"{known}: {next(validator.iter_errors(document)).message[:200]}"
    for old, new, line, _ in MISTAKES[:6]:
        if line not in (6, 7):  # values of a grid, which may be anything
            assert not validator.is_valid(yaml.safe_load(GOOD.replace(old, new, 1))), new


def test_an_experiment_of_a_plugin_package_is_checked_where_it_lies(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    package = file.parents[2] / "package"
    theirs = package / "theirs" / "conf" / "experiment" / "of_a_package.yaml"
    theirs.parent.mkdir(parents=True)
    (package / "pyproject.toml").write_text("")
    theirs.write_text(GOOD)
    assert main(["check", str(theirs)]) == 0
    assert "nothing wrong; 12 rows, " in capsys.readouterr().out
    theirs.write_text(GOOD.replace("solver: primal_dual", "solver: of_a_package"))
    assert main(["check", str(theirs)]) == 2
    assert "unknown solver" in (error := capsys.readouterr().err)
    assert error.count("\n") == 1 and error.endswith(f"once it is installed: pip install {package}\n")
