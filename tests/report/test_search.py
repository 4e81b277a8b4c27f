"""A search is one experiment: trials in their order, the best by its mean, its command without the search."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from surfexp.commands.command_line import main
from surfexp.commands.searching import is_search, joined, repeatable
from surfexp.lab.experiment.configuration import Settings
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.records.table import Row
from surfexp.report.search import Search, Trial, draw, search_of, searched

COMMAND = (
    "surfexp run experiment=x 'figures=[]' hydra/sweeper=optuna objective=rmse 'model.weight=interval(0.1,2)' "
    "solver=choice(newton,primal_dual) hydra.sweeper.n_trials=3 model.weight_other=1"
)


def row(w: float, solver: str, rmse: float, failure: str = "") -> Row:
    parameters: dict[str, Any] = {"model.weight": w, "solver.name": solver, "image.noise": 3.0}
    return Row(Leaf("key", "configuration", {}), parameters, {"rmse": rmse}, 1.0, failure=failure)


ROWS = [row(0.5, "newton", 3.0), row(0.5, "newton", 1.0), row(1.0, "newton", 0.5), row(1.0, "newton", 2.5, "it died")]
ROWS += [row(0.25, "primal_dual", 1.0), row(0.25, "primal_dual", 2.0)]


def test_trials_are_in_order_and_a_failed_row_leaves_a_trial_without_a_value() -> None:
    search = search_of(ROWS, "rmse", COMMAND)
    assert search is not None and search.best is not None
    assert [trial.options["model.weight"] for trial in search.trials] == [0.5, 1.0, 0.25]
    assert [trial.value for trial in search.trials][::2] == [2.0, 1.5] and math.isnan(search.trials[1].value)
    assert search.best.options == {"model.weight": 0.25, "solver.name": "primal_dual"}
    assert "3 trials" in search.sentence and "the least rmse, 1.5, at model.weight = 0.25" in search.sentence


def test_the_command_runs_the_best_trial_alone() -> None:
    search = search_of(ROWS, "rmse", COMMAND)
    assert search is not None
    expected = "surfexp run experiment=x 'figures=[]' model.weight_other=1 model.weight=0.25 solver=primal_dual"
    assert search.command == expected


def test_what_asks_for_no_search_has_none() -> None:
    assert search_of(ROWS, None, COMMAND) is None
    assert search_of(ROWS, "rmse", "surfexp run experiment=x objective=rmse model.weight=1,2") is None
    assert search_of([], "rmse", COMMAND) is None


def test_without_a_value_no_trial_is_best() -> None:
    search = search_of([row(1.0, "newton", math.nan)], "rmse", COMMAND)
    assert search is not None and search.best is None and "none has a value" in search.sentence
    assert "<svg" in draw(search)


def test_the_picture_is_the_same_bytes_and_its_text_is_text() -> None:
    options = [{"model.weight": k / 10, "solver.name": name} for k, name in enumerate(["newton", "primal_dual"] * 5)]
    search = Search("rmse", [Trial(some, float((k - 4) ** 2)) for k, some in enumerate(options)], [])
    assert draw(search) == draw(search)
    assert all(f">{text}</text>" in draw(search) for text in ("trial", "model.weight", "newton", "rmse"))


def test_swept_options_are_found_as_hydra_finds_them() -> None:
    assert searched(["a.b=1", "c.d=1,2", "solver=choice(x,y)", "e=[1,2]", "--cfg", "f.g=range(1,3)"]) == [
        "c.d",
        "solver.name",
        "f.g",
    ]


def test_a_search_has_a_seed_unless_it_is_given_one() -> None:
    asked = ["hydra/sweeper=optuna", "model.weight=interval(0,1)"]
    assert is_search(asked) and repeatable(asked)[-1] == "hydra.sweeper.sampler.seed=1"
    own = [*asked, "hydra.sweeper.sampler.seed=7"]
    assert repeatable(own) == own and repeatable(["model.weight=1"]) == ["model.weight=1"]


def test_trials_are_rows_of_one_plan_each_once() -> None:
    plans = [Plan(Settings(), leaves=[Leaf(key, "", {}) for key in keys], requested=2) for keys in ("ab", "bc")]
    both = joined(*plans)
    assert [leaf.key for leaf in both.leaves] == ["a", "b", "c"] and both.requested == 4


@pytest.mark.slow
def test_a_search_asked_again_computes_nothing_and_is_one_table(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = [
        "run",
        "experiment=quickstart",
        "surface=icosphere",
        "surface.levels=3",
        "image=two_phase",
        "image.noise=20",
    ]
    asked += ["model=rof", "solver=primal_dual", "operator=fem", "figures=[]", "columns=[rmse]", "hydra/sweeper=optuna"]
    asked += ["objective=rmse", "model.weight=interval(0.5,2)", "hydra.sweeper.n_trials=4"]
    assert main(asked) in (0, 3)
    first = capsys.readouterr().out
    stored = sorted((working_folder / "results" / "store").rglob("*"))
    assert main(asked) in (0, 3)
    assert sorted((working_folder / "results" / "store").rglob("*")) == stored
    again = capsys.readouterr().out
    said = [line for line in first.splitlines() if line.startswith(("search", "again"))]
    assert len(said) == 2 and all(line in again for line in said) and "4 trials of model.weight" in said[0]
    page = (working_folder / "results" / "quickstart" / "report.html").read_text()
    assert "4 trials of model.weight" in page and "data:image/svg+xml;base64," in page
