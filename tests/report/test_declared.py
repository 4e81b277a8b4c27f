"""Whatever names a metric, a parameter or a value names one that exists, or is refused before anything runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from surfexp.contract.metric import Metric, find_metric
from surfexp.lab.composition.launch import launch
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.loading import load_all
from surfexp.records.table import rows_of
from surfexp.report.declared import check_names, declared, leave_out_columns

load_all(Path("/nonexistent"))
ROOT = Path(__file__).resolve().parents[2]
CLAIM: dict[str, Any] = {
    "claim": "small",
    "quantity": {"all": "rmse"},
    "rows": {"solver.name": "primal_dual"},
    "between": [None, 20],
    "because": "half of the noise",
}
EXPERIMENT: dict[str, Any] = {
    "surface": {"name": "icosphere", "levels": 3},
    "image": {"name": "picture", "noise": 40.0},
    "operator": "fem",
    "model": "rof",
    "grid": {"solver": ["primal_dual", "split_bregman"], "image.seed": [0, 1]},
}


def plan_of(**changes: Any) -> Plan:
    return make_plan(expand(EXPERIMENT | changes))


def refusal(**changes: Any) -> str:
    with pytest.raises(UserError) as error:
        check_names(plan_of(**changes))
    return str(error.value)


def test_placeholders_stand_for_what_only_an_experiment_knows() -> None:
    metrics = {"dice {reference}": Metric("overlap"), "dice": Metric("all"), "p (a) {x}": Metric("brackets")}
    assert find_metric("dice sulc", metrics) == Metric("overlap")
    assert find_metric("dice", metrics) == Metric("all")
    assert find_metric("p (a) b", metrics) == Metric("brackets")
    assert find_metric("dice ", metrics) is find_metric("a dice sulc", metrics) is None


def test_a_solver_declares_its_own_metrics_and_those_of_its_model() -> None:
    plan = plan_of()
    metrics = declared(plan.nodes, plan.leaves[0].key)
    assert metrics["relative_gap"].better == metrics["rmse"].better == "lower" and metrics["psnr"].unit == "dB"
    assert "c1" not in metrics and "area" not in metrics


def test_a_statistic_of_one_solver_hands_its_metrics_on() -> None:
    plan = plan_of(target="statistic", statistic="energy_excess", grid={"solver": ["split_bregman"]})
    (leaf,) = plan.leaves
    metrics = declared(plan.nodes, leaf.key)
    assert {"energy_excess", "relative_gap", "rmse"} <= set(metrics)
    (found,) = rows_of(plan, Path("/nonexistent"))
    assert found.answers


def test_a_statistic_of_data_alone_is_no_answer_and_hands_nothing_on() -> None:
    plan = plan_of(target="statistic", statistic="operator_errors", grid={})
    (leaf,) = plan.leaves
    assert "gradient_error" in (metrics := declared(plan.nodes, leaf.key)) and "relative_gap" not in metrics
    (found,) = rows_of(plan, Path("/nonexistent"))
    assert not found.answers


@pytest.mark.parametrize(
    "claim",
    [
        {},
        {"quantity": {"all": "seconds"}},
        {"rows": {"image.seed": [0, 1]}},
        {"rows": {"solver.name": "newton"}},  # exists, though this experiment does not take it
        {"quantity": {"ratio": "rmse"}, "rows": [{}, {"solver.name": "split_bregman"}]},
    ],
)
def test_names_that_exist_are_allowed(claim: dict[str, Any]) -> None:
    check_names(plan_of(claims=[CLAIM | claim], columns=["rmse", "seconds"], objective="relative_gap"))


@pytest.mark.parametrize(
    ("claim", "message"),
    [
        ({"quantity": {"all": "rsme"}}, "unknown metric in claim (small) 'rsme'; did you mean 'rmse'?"),
        ({"quantity": {"all": "c1"}}, "unknown metric in claim (small) 'c1'"),
        ({"rows": {"solver.nme": "x"}}, "unknown parameter in claim (small) 'solver.nme'; did you mean 'solver.name'?"),
        ({"rows": {"solver.name": "primal_dul"}}, "'primal_dul'; did you mean 'primal_dual'?"),
        ({"rows": {"image.seed": 3}}, "unknown value of image.seed in claim (small) '3'"),
        ({"rows": {"image.seed": [0, 3]}}, "unknown value of image.seed in claim (small) '3'"),
        (
            {"quantity": {"ratio": "rmse"}, "rows": [{}, {"solver.name": "split_bergman"}]},
            "did you mean 'split_bregman'?",
        ),
        ({"betwen": [1, 2]}, "unknown key 'betwen'; did you mean 'between'?"),
    ],
)
def test_a_misspelt_name_in_a_claim_is_refused(claim: dict[str, Any], message: str) -> None:
    assert message in refusal(claims=[CLAIM | claim])


def test_misspelt_columns_objectives_and_options_are_refused() -> None:
    assert "unknown metric in columns 'rsme'; did you mean 'rmse'?" in refusal(columns=["rsme"])
    assert "unknown metric in objective 'rsme'; did you mean 'rmse'?" in refusal(objective="rsme")
    sweep = {"name": "sweep", "metric": "rsme", "x_label": "seed", "inputs": {"solvers": {"dataset": "seeds"}}}
    datasets = {"seeds": [{"image": {"seed": 0}}, {"image": {"seed": 1}}]}
    assert "unknown metric in figure/sweep.metric 'rsme'; did you mean 'rmse'?" in refusal(
        datasets=datasets, figures=[sweep]
    )


@pytest.mark.parametrize("name", sorted(file.stem for file in (ROOT / "conf" / "experiment").glob("*.yaml")))
def test_every_experiment_names_what_exists(name: str, working_folder: Path) -> None:
    launch([f"experiment={name}"], check_names)


def test_columns_of_a_plugin_that_a_request_replaced_are_left_out() -> None:
    columns = ["relative_gap", "labelling_gap", "rmse"]
    plan = plan_of(columns=columns)
    shared = plan.leaves[0].settings is plan.leaves[1].settings
    assert leave_out_columns(plan, ["model"]) == ["labelling_gap"]
    assert [leaf.settings["columns"] for leaf in plan.leaves] == [["relative_gap", "rmse"]] * len(plan.leaves)
    assert (plan.leaves[0].settings is plan.leaves[1].settings) == shared
    check_names(plan)


def test_a_solver_without_a_model_leaves_out_the_columns_of_models(working_folder: Path) -> None:
    left_out: list[str] = []

    def check(plan: Plan) -> None:
        left_out.extend(leave_out_columns(plan, ["solver"]))
        check_names(plan)

    launch(["solver=chan_vese"], check)
    assert "labelling_gap" in left_out


def test_columns_that_no_plugin_has_stay_and_are_refused() -> None:
    for replaced, columns in ((["model"], ["labeling_gap"]), ([], ["labelling_gap"]), (["surface"], ["labelling_gap"])):
        plan = plan_of(columns=columns)
        assert leave_out_columns(plan, replaced) == [] and plan.leaves[0].settings["columns"] == columns
        with pytest.raises(UserError, match="unknown metric in columns"):
            check_names(plan)
