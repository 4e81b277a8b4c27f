"""A list of experiments is one request for each, whatever letters their names have."""

from __future__ import annotations

import pytest

from surfexp.commands.several_experiments import apart, each
from surfexp.lab.errors import StageFailure, UserError


@pytest.mark.parametrize("names", ["a,b", "my-exp,other", "fig.2,2nd_try", "a, b"])
def test_names_of_experiments_are_told_apart(names: str) -> None:
    first, second = names.replace(" ", "").split(",")
    asked = [[f"experiment={name}", "solver=a,b"] for name in (first, second)]
    assert apart([f"experiment={names}", "solver=a,b"]) == asked
    assert apart([f"experiment=choice({names})", "solver=a,b"]) == asked
    assert apart([f"experiment={first},{second},{first}", "solver=a,b"]) == asked


def test_mistakes_are_told_before_the_first_runs_and_the_others_run(capsys: pytest.CaptureFixture[str]) -> None:
    done: list[str] = []

    def check(arguments: list[str]) -> None:
        if arguments == ["experiment=c"]:
            raise UserError("c is wrong")

    def run(arguments: list[str]) -> int:
        done.append(capsys.readouterr().err)
        if arguments == ["experiment=b"]:
            raise StageFailure("b failed")
        return 3

    assert each(run, [[f"experiment={name}"] for name in "abcd"], check) == 1
    assert len(done) == 3 and done[0] == "surfexp: c is wrong\n" and done[2] == "surfexp: b failed\n"
    assert capsys.readouterr().err == "surfexp: 2 of 4 experiments did not end: b, c\n"


@pytest.mark.parametrize("text", ["experiment=a", "experiment=a,", "solver=a,b"])
def test_what_is_no_list_of_names_stays(text: str) -> None:
    assert apart([text]) == [[text]]
