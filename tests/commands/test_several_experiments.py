"""A list of experiments is one request for each, whatever letters their names have."""

from __future__ import annotations

import pytest

from surfexp.commands.several_experiments import apart


@pytest.mark.parametrize("names", ["a,b", "my-exp,other", "fig.2,2nd_try", "a, b"])
def test_names_of_experiments_are_told_apart(names: str) -> None:
    first, second = names.replace(" ", "").split(",")
    asked = [[f"experiment={name}", "solver=a,b"] for name in (first, second)]
    assert apart([f"experiment={names}", "solver=a,b"]) == asked
    assert apart([f"experiment=choice({names})", "solver=a,b"]) == asked
    assert apart([f"experiment={first},{second},{first}", "solver=a,b"]) == asked


@pytest.mark.parametrize("text", ["experiment=a", "experiment=a,", "solver=a,b"])
def test_what_is_no_list_of_names_stays(text: str) -> None:
    assert apart([text]) == [[text]]
