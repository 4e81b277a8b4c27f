"""`sx.load` and `sx.run`: the rows, pictures and arrays of an experiment in Python."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

import surfexp as sx
from surfexp import experiments, extras
from surfexp.report import convergence

TOYS = Path(__file__).with_name("toy_plugins.py")
CHAIN = """\
# @package _global_
experiment: chain
title: A toy
surface: toy_triangle
scalar: toy_boundary
pairing:
  name: toy_distance
  inputs:
    source: {scalar: toy_eigenfunction, weighted: {name: toy_flux, inputs: {weight: {scalar: toy_boundary}}}}
    target: {scalar: {name: toy_boundary, shift: 1.0}}
target: pairing
"""


@pytest.fixture
def laboratory(working_folder: Path) -> Path:
    (working_folder / "plugins" / "pairing").mkdir(parents=True)
    # a link, so that one process never meets the toys under two names
    (working_folder / "plugins" / "pairing" / "toys.py").symlink_to(TOYS)
    (working_folder / "conf" / "experiment").mkdir(parents=True)
    (working_folder / "conf" / "experiment" / "chain.yaml").write_text(CHAIN)
    return working_folder


@pytest.mark.slow
def test_a_run_comes_back_as_a_table_with_its_results(laboratory: Path) -> None:
    found = sx.run("chain", cores=1)
    (key,) = found.table.index
    assert found.table.loc[key, "distance"] == found.result(key).metrics["distance"]
    assert found.table.loc[key, "failure"] == "" and (found.folder / "report.html").exists()
    assert isinstance(found.arrays(key), dict)
    again = sx.load("chain")
    assert again.table.drop(columns="seconds").equals(found.table.drop(columns="seconds"))
    with pytest.raises(ValueError, match="no row 'nosuch'"):
        found.result("nosuch")


def test_without_the_laboratory_one_line_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None if name == "hydra" else object())
    for call in (sx.load, sx.run):
        with pytest.raises(
            ImportError, match=r"needs hydra-core, which is not installed: pip install 'surfexp\[lab\]'$"
        ):
            call("quickstart")


def test_overrides_are_written_as_on_the_command_line() -> None:
    written = [experiments._written(value) for value in (True, None, 1e-5, "newton", ["a", 2])]
    assert written == ["true", "null", "1e-05", "newton", "a,2"]


def test_a_row_that_did_not_converge_is_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    ended = subprocess.CompletedProcess([], 3, stderr="[1/1] solver/newton\nsurfexp: warning: cup: newton: gap\n")
    monkeypatch.setattr(experiments.subprocess, "run", lambda *_, **__: ended)
    monkeypatch.setattr(experiments, "load", lambda *given: given)
    with pytest.warns(UserWarning, match=r"^cup: newton: gap$"):
        assert sx.run("rof_cup") == ("rof_cup", "results")
    assert experiments.UNCONVERGED == convergence.UNCONVERGED
