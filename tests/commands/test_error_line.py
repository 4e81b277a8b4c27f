"""Errors fit a terminal whatever was typed: nothing is echoed at length, and what is left out is said."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.commands.command_line import main
from surfexp.commands.error_line import LONGEST_LINE, error_line, tell
from surfexp.lab.errors import unknown


def test_a_long_value_is_cut_and_a_path_is_not() -> None:
    line = error_line(f"tolerance = {'9' * 400}: not a number")
    assert line == f"tolerance = {'9' * 20}...{'9' * 10} (400 characters): not a number"
    path = f"/home/{'folder/' * 20}mesh.ply is missing"
    assert error_line(path) == path


@given(st.lists(st.text("abcdefgh", min_size=4, max_size=30), min_size=40, max_size=80, unique=True))
def test_a_list_of_choices_fits_and_says_how_many_more_there_are(names: list[str]) -> None:
    whole = str(unknown("command", "zzzzzz", names))
    line = error_line(whole)
    assert len(line) <= LONGEST_LINE
    if line != whole:
        said, shown = line.rpartition(", ")[2], line.partition("choose from: ")[2].split(", ")[:-1]
        assert (
            len(whole) > LONGEST_LINE
            and said == f"{len(names) - len(shown):,} more"
            and shown == sorted(names)[: len(shown)]
        )


@given(
    st.lists(st.text("abcdefgh", min_size=4, max_size=30), min_size=40, max_size=80, unique=True),
    st.sampled_from(
        [" (crooked.py, line 2: invalid syntax)", "; or bring your own, as a file", ": nothing was computed"]
    ),
)
def test_what_a_message_says_after_its_choices_stays(names: list[str], reason: str) -> None:
    line = error_line(f"{unknown('solver', 'zzzzzz', names)}{reason}")
    assert len(line) <= LONGEST_LINE and line.endswith(f" more{reason}")


def test_the_command_line_prints_such_lines(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["frobnicate"]) == 2
    line = capsys.readouterr().err.strip()
    assert len(line) <= LONGEST_LINE + len("surfexp: ") and line.endswith(" more")


@pytest.mark.parametrize("way", ["choose from", "choose surface= one of"])
def test_long_lists_are_cut_whatever_introduces_them(way: str) -> None:
    line = error_line(f"no surface; {way}: {', '.join(f'surface{k}' for k in range(50))}")
    assert len(line) <= LONGEST_LINE and f"{way}: surface0, surface1, " in line and line.endswith(" more")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["collect"], "missing argument 'SOURCE'; surfexp collect --help"),
        (["report", "x", "--to", "y"], "unknown option '--to'; choose from: --beside, "),
        (["completion"], "missing argument '{bash|zsh|fish}'. Choose from: bash, zsh, fish"),
        (["zzzzzzzz"], "unknown command 'zzzzzzzz'; choose from: align, "),
        (["run", "experiment=a b"], "unknown experiment 'a b'; choose from: "),
        (["plan", "experiment="], "unknown experiment ''; choose from: "),
        (["plan", "experiment=quickstart,isospectral drums"], "did you mean 'isospectral_drums'?"),
    ],
)
def test_a_mistake_is_one_line_whatever_parses_it(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1 and len(told) <= 300


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("/proc/.writing-k3v9/x.npz", "/proc cannot be written to: no such file or directory"),
        ("/data/a.csv", "/data/a.csv: no such file or directory"),
    ],
)
def test_a_refusal_of_the_system_has_no_number(file: str, line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert tell(FileNotFoundError(2, "No such file or directory", file)) == 2
    assert capsys.readouterr().err == f"surfexp: {line}\n"
