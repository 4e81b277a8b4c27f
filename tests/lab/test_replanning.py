"""A plan of another place planned here: equal keys for equal code, whatever inputs a stage takes, and its mistakes told."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.replanning import replanned
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry

TRIANGLE = {"name": "toy_triangle", "size": 2.0}
ITEMS = [{"label": name, "class": name, "surface": {"name": "toy_triangle", "size": len(name)}} for name in ("a", "bb")]
DISTANCE: dict[str, Any] = {
    "target": "pairing",
    "surface": TRIANGLE,
    "pairing": {
        "name": "toy_distance",
        "inputs": {"source": {"scalar": "toy_boundary"}, "target": {"scalar": {"name": "toy_boundary", "shift": 1.0}}},
    },
}
SPREAD: dict[str, Any] = {
    "target": "pairing",
    "datasets": {"size": ITEMS},
    "scalar": "toy_boundary",
    "pairing": {"name": "toy_spread", "inputs": {"features": {"dataset": "size"}, "named": {"dataset": "size"}}},
}
MEMBERS: dict[str, Any] = SPREAD | {"pairing": {"name": "toy_members", "inputs": {"features": {"dataset": "size"}}}}


@pytest.fixture(autouse=True)
def toys() -> None:
    registry.load_file(Path(__file__).with_name("toy_plugins.py"))


def moved(plan: Plan) -> Plan:
    """The plan as it is elsewhere: no file of code is where it was."""
    return replace(plan, nodes={key: replace(node, file="", code="") for key, node in plan.nodes.items()})


@pytest.mark.parametrize(
    "configuration", [DISTANCE, SPREAD, MEMBERS, DISTANCE | {"grid": {"surface.size": [1.0, 3.0]}}]
)
def test_the_same_code_gives_the_same_keys(configuration: dict[str, Any]) -> None:
    plan = make_plan(expand(configuration))
    again, keys = replanned(moved(plan))
    assert keys == {key: key for key in plan.nodes}
    assert again.nodes == plan.nodes and again.leaves == plan.leaves and again.identity == plan.identity


def test_another_option_gives_other_keys_downstream_alone() -> None:
    plan = make_plan(expand(DISTANCE))
    (shifted,) = (key for key, node in plan.nodes.items() if node.options.get("shift") == 1.0)
    plan.nodes[shifted] = replace(plan.nodes[shifted], options={"shift": 5.0})
    changed = {old for old, new in replanned(plan)[1].items() if old != new}
    assert changed == {shifted, plan.leaves[0].key}


def test_plugins_that_are_gone_or_take_something_else_are_told() -> None:
    plan = make_plan(expand(DISTANCE))
    key = plan.leaves[0].key
    plan.nodes[key] = replace(plan.nodes[key], inputs={"source": plan.nodes[key].inputs["source"]})
    with pytest.raises(UserError, match="takes the inputs source, target here, the plan gives source"):
        replanned(plan)
    plan.nodes[key] = replace(plan.nodes[key], plugin="toy_distances")
    with pytest.raises(UserError, match="did you mean 'toy_distance'"):
        replanned(plan)
