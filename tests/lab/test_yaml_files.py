"""Mistakes in the files of experiments: one line with the file, the line and what is wrong, exit code 2."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from surfexp.commands.command_line import main
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.yaml_files import check_variants, read_yaml
from surfexp.lab.registry.folders import experiments

BOMB = "a0: &a0 [x, x]\n" + "".join(f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]\n" for k in range(1, 9))
MISTAKES = {
    "a: [": "line 1: not YAML: expected the node content",
    "title: x\n\tx: 1\n": "line 2: not YAML: found character",
    "a: \x00": "special characters are not allowed",
    'title: "x\\e[2J"\n': "line 1: the text holds the control code '\\x1b', which steers a terminal",
    '"x\\e": 1\n': "line 1: the text holds the control code '\\x1b', which steers a terminal",
    "a: &a [*a]\n": "line 1: an alias stands inside of what it is an alias of",
    "experiment: sent\nsurface:\n  name: cup\n  name: torus\n": "line 4: key 'name' stands there twice",
    BOMB: "its aliases unfold to over 100,000 entries",
    "a: *unknown\n": "line 1: not YAML: found undefined alias",
    "title: !!python/object/apply:os.system [x]\n": "line 1: not YAML: could not determine a constructor",
    "- a\n": "holds list, a mapping of options is needed",
    "": "holds NoneType",
    "a: " + "[" * 3000: "",
}


@pytest.mark.parametrize("text", MISTAKES, ids=range(len(MISTAKES)))
def test_a_mistake_is_one_line_with_its_place(
    text: str, working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = working_folder / "conf" / "experiment"
    folder.mkdir(parents=True)
    (folder / "sent.yaml").write_text(text)
    assert main(["plan", "experiment=sent"]) == 2
    said = capsys.readouterr().err.strip()
    assert MISTAKES[text] in said and "sent.yaml" in said and "\n" not in said and len(said) <= 400


def test_bytes_that_are_no_text_are_told(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = working_folder / "conf" / "experiment"
    folder.mkdir(parents=True)
    (folder / "sent.yaml").write_bytes(b"title: \xe9t\xe9\n")
    assert main(["info", "sent"]) == 2
    assert "byte 7 is no UTF-8" in capsys.readouterr().err


def test_every_experiment_that_ships_is_read(working_folder: Path) -> None:
    for name, file in experiments().items():
        assert read_yaml(file)["title"], name


@pytest.mark.parametrize(
    ("configuration", "said"),
    [
        ({"grid": 3}, "grid is 3, options with lists of values are needed"),
        ({"grid": {"solver.tolerance": 3}}, "grid: solver.tolerance is 3, a list of values is needed"),
        ({"variants": 3}, "variants is 3, a list of partial configurations"),
        ({"variants": [{}, "x"]}, "variant 2 is 'x', a partial configuration is needed"),
        ({"variants": [{"grid": "x"}]}, "grid of variant 1 is 'x', options with lists"),
        ({"variants": [{}, {"grid": {"a": {"b": 1}}}]}, "grid of variant 2: a is {'b': 1}, a list"),
        ({"grid": ["9" * 400]}, "options with lists of values"),
    ],
)
def test_variants_and_grids_of_another_shape_are_refused_with_their_place(
    configuration: dict[str, object], said: str
) -> None:
    with pytest.raises(UserError, match=re.escape(said)) as caught:
        check_variants(configuration)
    assert len(str(caught.value)) < 200


def test_sound_variants_and_grids_pass() -> None:
    check_variants({"grid": {"a": [1]}, "variants": [{"grid": {"b": [{"name": "x"}, "y"]}}, {"grid": None}, {}]})
    check_variants({"grid": None, "variants": None})
