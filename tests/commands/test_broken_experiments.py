"""One file that is no experiment takes nothing from the others, and is named."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.commands.command_line import main


@pytest.mark.parametrize("content", [b"title: x: y", b"title: [a", b"\xff\xfe bad", b"- a list"])
@pytest.mark.parametrize("command", [["list", "experiment"], ["info", "figure 2.3"], ["info", "table 2.2"]])
def test_a_file_that_is_no_experiment_is_named_and_left_out(
    working_folder: Path, command: list[str], content: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("conf/experiment").mkdir(parents=True)
    Path("conf/experiment/broken.yaml").write_bytes(content)
    assert main(command) == 0
    said = capsys.readouterr()
    assert "broken.yaml is no experiment and left out; surfexp check" in said.err and len(said.err.splitlines()) == 1
    assert len(said.out.splitlines()) >= 1


@pytest.mark.parametrize("content", ["title: 3\nstart: x\nchapter: y", "chapter: [1]", "start: [2]"])
def test_odd_places_are_none(working_folder: Path, content: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("conf/experiment").mkdir(parents=True)
    Path("conf/experiment/odd.yaml").write_text(content)
    assert main(["list", "experiment"]) == 0
    assert "odd" in capsys.readouterr().out


def test_a_list_that_is_too_short_is_said_to_be(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "experiment=quickstart", "surface=ellipsoid", "surface.semiaxes=[1,2]"]) == 2
    assert "surface/ellipsoid.semiaxes has 2 values, more are needed" in capsys.readouterr().err
