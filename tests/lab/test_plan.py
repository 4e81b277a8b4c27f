"""The stage contract: recurring kinds, two inputs of one kind, lists over axes, keys, cycles, mistakes."""

from __future__ import annotations

import os
import shutil
import time
from dataclasses import replace
from pathlib import Path

import pytest

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan import outcome
from surfexp.lab.plan.plan import Plan, latest_plan, read_plan, stored_inputs
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.running import stage
from surfexp.lab.store import store

TOYS = Path(__file__).with_name("toy_plugins.py")
CHAIN = {
    "scalar": "toy_eigenfunction",
    "weighted": {"name": "toy_flux", "inputs": {"weight": {"scalar": {"name": "toy_boundary", "shift": 1.0}}}},
}
DOUBLED = {"name": "toy_doubled", "inputs": {"original": {"surface": {"name": "toy_triangle", "size": 3.0}}}}
TWICE = {"name": "toy_doubled", "inputs": {"original": {"surface": DOUBLED}}}
DISTANCE = {
    "target": "pairing",
    "surface": {"name": "toy_triangle", "size": 2.0},
    "pairing": {
        "name": "toy_distance",
        "inputs": {
            "source": CHAIN,
            "target": {"surface": {"name": "toy_triangle", "size": 3.0}, "scalar": "toy_boundary"},
        },
    },
}


@pytest.fixture(autouse=True)
def toys() -> None:
    registry.load_file(TOYS)


def run(configuration: dict, results: Path):
    plan = make_plan(expand(configuration))
    path = plan.write(results)
    for key, node in plan.nodes.items():
        if node.kind != "model":
            assert stage.run_stage(path, key) == 0
    return plan, store.load(results, configuration["target"], plan.leaves[0].key)


def test_chain_in_which_a_kind_recurs_and_two_inputs_of_one_kind(tmp_path: Path) -> None:
    plan, pairing = run(DISTANCE, tmp_path)
    assert pairing.trace == "eigen(flux(boundary))~boundary"
    assert pairing.value == 7.0
    parameters = plan.parameters(plan.leaves[0])
    assert parameters["weight.shift"] == 1.0 and parameters["target.surface.size"] == 3.0
    assert len(plan.stored) == 7 and plan.requested == 8


def test_every_output_is_of_its_own_kind(tmp_path: Path) -> None:
    plan, _ = run(DISTANCE, tmp_path)
    for key, node in plan.nodes.items():
        assert isinstance(store.load(tmp_path, node.kind, key), registry.KINDS[node.kind].result)


def test_lists_fan_in_over_a_dataset(tmp_path: Path) -> None:
    items = [
        {"label": name, "surface": {"name": "toy_triangle", "size": size}}
        for name, size in (("small", 1.0), ("large", 4.0))
    ]
    configuration = {
        "target": "pairing",
        "datasets": {"subject": items},
        "scalar": "toy_boundary",
        "pairing": {
            "name": "toy_spread",
            "inputs": {"features": {"dataset": "subject"}, "named": {"dataset": "subject"}},
        },
    }
    plan, pairing = run(configuration, tmp_path)
    assert pairing.value == 3.0 and pairing.trace == "small,large"
    assert sum(node.kind == "scalar" for node in plan.nodes.values()) == 2
    with pytest.raises(UserError, match=r"'sujet'.*did you mean 'subject'"):
        make_plan([{**configuration, "pairing": {"name": "toy_spread", "inputs": {"features": {"dataset": "sujet"}}}}])


def test_members_may_differ_in_options_that_others_do_not_have() -> None:
    items = [{"surface": "toy_triangle"}, {"surface": DOUBLED}, {"surface": TWICE}]
    configuration = collection() | {"datasets": {"subject": items}}
    plan = make_plan(expand(configuration))
    parameters = plan.parameters(plan.leaves[0])
    assert parameters["surface.turned"] is None and parameters["surface.size"].startswith("2 values")


def collection(**members: dict[str, object]) -> dict[str, object]:
    surfaces = [
        {"label": name, "surface": {"name": "toy_triangle", "size": 2.0}, **part} for name, part in members.items()
    ]
    return {
        "target": "pairing",
        "datasets": {"subject": surfaces},
        "scalar": "toy_boundary",
        "pairing": {"name": "toy_members", "inputs": {"features": {"dataset": "subject"}}},
    }


def test_facts_about_members_reach_the_method_and_its_key(tmp_path: Path) -> None:
    configuration = collection(one={"class": "round", "group": 9861, "level": 2}, two={})
    plan, pairing = run(configuration, tmp_path)
    assert pairing.trace == "round/9861/2.0,two/two/None"
    assert read_plan(plan.write(tmp_path)).nodes == plan.nodes
    key = plan.leaves[0].key
    assert run(configuration, tmp_path)[0].leaves[0].key == key
    other = collection(one={"class": "long", "group": 9861, "level": 2}, two={})
    assert run(other, tmp_path)[0].leaves[0].key != key
    as_list = {**configuration, "datasets": {"subject": [{"class": "a", "surface": {"name": "toy_triangle"}}]}}
    assert run(as_list, tmp_path)[1].trace == "a/0/None"


@pytest.mark.parametrize(
    ("part", "message"),
    [
        ({"clas": "round"}, r"key of an item of dataset 'subject' 'clas'; did you mean 'class'"),
        ({"level": "fine"}, r"datasets.subject.*level = 'fine': .*valid number"),
        ({"class": ["round"]}, r"datasets.subject.*class = \['round'\]: .*valid string"),
    ],
)
def test_wrong_facts_about_members_are_refused(part: dict[str, object], message: str) -> None:
    with pytest.raises(UserError, match=message):
        make_plan([collection(one=part)])
    with pytest.raises(UserError, match="datasets"):
        make_plan([{**collection(), "datasets": {"subject": None}}])


def test_cycles_are_named() -> None:
    circular = {"target": "scalar", "surface": "toy_triangle", "scalar": "toy_eigenfunction", "weighted": "toy_flux"}
    with pytest.raises(UserError, match="cycle: scalar/toy_eigenfunction -> weighted/toy_flux -> scalar/toy_eigen"):
        make_plan([circular])


def test_unused_options_do_not_change_a_key_and_used_ones_do() -> None:
    base = {"target": "scalar", "surface": "toy_triangle", "scalar": "toy_boundary"}
    key = make_plan([base]).leaves[0].key
    assert make_plan([{**base, "weighted": "toy_flux", "title": "another"}]).leaves[0].key == key
    assert make_plan([{**base, "scalar": {"name": "toy_boundary", "shift": 0.0}}]).leaves[0].key == key
    assert make_plan([{**base, "scalar": {"name": "toy_boundary", "shift": 0.5}}]).leaves[0].key != key
    assert make_plan([{**base, "surface": {"name": "toy_triangle", "size": 2}}]).leaves[0].key != key


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"scalar": "toy_boundry"}, r"scalar plugin 'toy_boundry'; did you mean 'toy_boundary'"),
        (
            {"scalar": {"name": "toy_boundary", "shfit": 1}},
            r"option of scalar/toy_boundary 'shfit'; did you mean 'shift'",
        ),
        ({"surface": {"name": "toy_triangle", "size": -1.0}}, r"surface/toy_triangle.size = -1.0: .*greater than 0"),
        ({"surface": None}, r"no surface is configured, wanted by scalar/toy_boundary; choose surface="),
        ({"expriment": "x"}, r"configuration key 'expriment'; did you mean 'experiment'"),
        ({"target": "model", "model": "rof"}, r"target 'model' is not stored; end in a kind that is: surface, image, "),
        ({"cores": 0}, r"configuration.cores = 0: .*greater than or equal to 1"),
        ({"scalar": {"name": "toy_boundary", "inputs": {"surfce": {}}}}, r"input of scalar/toy_boundary 'surfce'"),
    ],
)
def test_mistakes_are_refused_with_the_nearest_choice(change: dict, message: str) -> None:
    base = {"target": "scalar", "surface": "toy_triangle", "scalar": "toy_boundary"}
    with pytest.raises(UserError, match=message):
        make_plan(expand({**base, **change}))


def test_variants_and_grids_are_a_union_of_products_and_the_command_line_wins() -> None:
    configuration = {
        "surface": {"name": "toy_triangle", "size": 1.0},
        "scalar": {"name": "toy_boundary", "shift": 0.0},
        "variants": [
            {"scalar": {"shift": 5.0}, "grid": {"surface.size": [1.0, 2.0]}},
            {"scalar": "toy_eigenfunction", "grid": {"weighted": ["toy_flux"]}},
        ],
    }
    leaves = expand(configuration)
    assert [leaf["surface"].get("size") for leaf in leaves] == [1.0, 2.0, 1.0]
    assert leaves[0]["scalar"] == {"name": "toy_boundary", "shift": 5.0}
    assert leaves[2]["scalar"] == {"name": "toy_eigenfunction"} and leaves[2]["weighted"] == {"name": "toy_flux"}
    forced = expand(configuration, {"surface.size": 9.0, "scalar.shift": 0.5})
    assert [leaf["surface"]["size"] for leaf in forced] == [9.0, 9.0, 9.0]
    assert forced[0]["scalar"]["shift"] == 0.5 and forced[2]["scalar"] == {"name": "toy_eigenfunction"}
    assert all(leaf["surface"] == {"name": "file"} for leaf in expand(configuration, {"surface": {"name": "file"}}))
    both = {"surface.size": 7.0, "surface": {"name": "toy_triangle", "size": 1.0}}  # the option first, then the plugin
    assert all(leaf["surface"]["size"] == 7.0 for leaf in expand(configuration, both))
    with pytest.raises(UserError, match="option of surface/toy_triangle 'szie'; did you mean 'size'"):
        expand(configuration, {"surface.szie": 1.0})


def test_plans_read_back_and_results_are_the_same_bytes(tmp_path: Path) -> None:
    plan, _ = run(DISTANCE, tmp_path / "a")
    again = read_plan(plan.write(tmp_path / "a"))
    assert again.nodes == plan.nodes and again.leaves == plan.leaves
    assert stored_inputs(plan.nodes, plan.leaves[0].key)
    run(DISTANCE, tmp_path / "b")
    for file in (tmp_path / "a" / "store").rglob("*.*"):
        assert file.read_bytes() == (tmp_path / "b" / "store" / file.relative_to(tmp_path / "a" / "store")).read_bytes()
    shutil.rmtree(tmp_path / "b")


def test_a_failed_stage_leaves_its_message_and_no_result(tmp_path: Path) -> None:
    plan = make_plan([{"target": "pairing", "surface": "toy_triangle", "pairing": "toy_failure"}])
    path = plan.write(tmp_path)
    codes = [stage.run_stage(path, key) for key in plan.nodes]
    assert codes == [0, 1]
    key = plan.leaves[0].key
    assert not store.is_done(tmp_path, "pairing", key)
    assert outcome.read_event(tmp_path, "pairing", key)["failure"].startswith(
        "pairing/toy_failure: surface has area 0.5"
    )


def test_where_clocks_matter_the_median_of_calls_after_the_first_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first call compiles, and a slow one among few is chance; calls end when they have taken long enough."""
    configuration = {"target": "surface", "surface": {"name": "toy_triangle", "size": 3.0}}
    method = registry.plugin("surface", "toy_triangle")
    long, short = (0.2, 0.01, 0.01, 0.15, *[0.01] * 20), (0.05, 0.45)
    for timing, lengths, expected, seconds in ((False, long, 1, 0.2), (True, long, 10, 0.01), (True, short, 4, 0.45)):
        calls = []

        def busy(calls=calls, lengths=lengths, **options):
            calls.append(None)
            begin = time.process_time()
            while time.process_time() - begin < lengths[min(len(calls), len(lengths)) - 1]:
                pass
            return method.function(**options)

        monkeypatch.setitem(registry.PLUGINS, ("surface", "toy_triangle"), replace(method, function=busy))
        folder = tmp_path / f"{timing} {len(lengths)}"
        plan, _ = run({**configuration, "timing": timing}, folder)
        event = outcome.read_event(folder, "surface", plan.leaves[0].key)
        assert len(calls) == expected and event["seconds"] == pytest.approx(seconds, rel=0.3)


def test_no_stage_kind_needs_a_plus_on_the_command_line(working_folder: Path) -> None:
    """`operator=` is in the list of Hydra's defaults and `eigensolver=` is not: nobody should have to know."""
    from surfexp.lab.composition.launch import launch

    plans: list[Plan] = []
    launch(["experiment=spectral_mds", "eigensolver=arpack", "operator=fem"], plans.append)
    assert {node.plugin for node in plans[0].nodes.values() if node.kind == "eigensolver"} == {"arpack"}


def test_the_latest_plan_is_the_one_written_last_whatever_the_times_of_files(tmp_path: Path) -> None:
    """They are those of copying where a results folder was copied."""
    base = {"experiment": "toys", "target": "scalar", "surface": "toy_triangle"}
    plans = [make_plan([base | {"scalar": {"name": "toy_boundary", "shift": shift}}]) for shift in (1.0, 2.0)]
    for order in (plans, plans[::-1], [*plans, plans[0]]):
        for age, plan in enumerate(order):
            os.utime(plan.write(tmp_path), (100 - age, 100 - age))
        assert latest_plan(tmp_path, "toys").identity == order[-1].identity
    (tmp_path / "plans" / "order.txt").unlink()  # of an earlier version
    os.utime(tmp_path / "plans" / f"toys-{plans[1].identity}.json", (200, 200))
    assert latest_plan(tmp_path, "toys").identity == plans[1].identity
