"""A stranger's experiment asks neither the environment nor the clock: the value reaches no plan, page or record."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from omegaconf import OmegaConf

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.interpolation import resolved

VALUE = "hidden-4711"


@pytest.mark.parametrize(
    "text",
    [
        "${oc.env:SECRET}",
        "a ${oc.env:SECRET,none} b",
        "${oc.decode:${oc.env:SECRET}}",
        "${${name}:SECRET}",
        "${now:%Y}",
    ],
)
def test_a_resolver_is_refused_unseen(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SECRET", VALUE)
    for config in ({"name": "oc.env", "caption": text}, {"name": "oc.env", "rows": [{"deep": [text]}]}):
        with pytest.raises(UserError, match="asks for more") as refused:
            resolved(OmegaConf.create(config))
        assert VALUE not in str(refused.value)


def test_what_another_key_says_is_filled_in() -> None:
    config = OmegaConf.create({"size": 3, "rows": ["${size}", "x: ${size}"], "time": "10:30", "set": "{a: 1}"})
    assert resolved(config) == {"size": 3, "rows": [3, "x: 3"], "time": "10:30", "set": "{a: 1}"}


@pytest.mark.parametrize("command", ["plan", "run"])
def test_the_environment_is_in_nothing_that_is_written(command: str, working_folder: Path) -> None:
    folder = working_folder / "conf" / "experiment"
    folder.mkdir(parents=True)
    text = "title: t\ncaption: '${oc.env:SECRET}'\nsurface: {name: icosphere, levels: 1}\noperator: fem\n"
    (folder / "strange.yaml").write_text(f"# @package _global_\n{text}")
    done = subprocess.run(
        [sys.executable, "-P", "-m", "surfexp.commands.command_line", command, "experiment=strange"],
        capture_output=True,
        text=True,
        env={**os.environ, "SECRET": VALUE},
    )
    assert done.returncode == 2 and "caption is '${oc.env:SECRET}'" in done.stderr
    written = [path.read_bytes() for path in working_folder.rglob("*") if path.is_file()]
    assert VALUE not in done.stdout + done.stderr and not any(VALUE.encode() in data for data in written)
