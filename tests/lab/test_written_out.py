"""What an experiment leaves to be worked out is what a file says that spells all of it: same stages, same rows."""

from __future__ import annotations

import copy
import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from surfexp.commands.request import plan_and_act
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.claim import Claim, read_claims
from surfexp.lab.experiment.configuration import expand, settings_of
from surfexp.lab.experiment.written_out import named, written_out
from surfexp.lab.plan.plan import Plan
from surfexp.lab.registry.folders import experiments

SHORT = """
title: Does the error grow with the noise?
surface: {name: icosphere, levels: 3}
image: {name: two_phase}
model: rof
solver: {name: primal_dual, tolerance: 1.0e-3}
grid: {image.noise: [10.0, 20.0], operator: [fem, {name: libigl}]}
repeat: {image.seed: 3}
figures: [{name: sweep, metric: rmse, against: image.noise}]
claims:
  - claim: Twice the noise gives at most thrice the error
    quantity: {ratio: rmse}
    rows: [{image.noise: 20.0}, {image.noise: 10.0}]
    between: [0, 3]
"""
LONG = """
# @package _global_
experiment: long
title: Does the error grow with the noise?
surface: {name: icosphere, levels: 3}
image: two_phase
model: rof
solver: {name: primal_dual, tolerance: 1.0e-3}
datasets:
  noises:
    - {label: fem 10 0, class: fem, level: 10.0, operator: fem, image: {noise: 10.0, seed: 0}}
    - {label: fem 10 1, class: fem, level: 10.0, operator: fem, image: {noise: 10.0, seed: 1}}
    - {label: fem 10 2, class: fem, level: 10.0, operator: fem, image: {noise: 10.0, seed: 2}}
    - {label: igl 10 0, class: libigl, level: 10.0, operator: libigl, image: {noise: 10.0, seed: 0}}
    - {label: igl 10 1, class: libigl, level: 10.0, operator: libigl, image: {noise: 10.0, seed: 1}}
    - {label: igl 10 2, class: libigl, level: 10.0, operator: libigl, image: {noise: 10.0, seed: 2}}
    - {label: fem 20 0, class: fem, level: 20.0, operator: fem, image: {noise: 20.0, seed: 0}}
    - {label: fem 20 1, class: fem, level: 20.0, operator: fem, image: {noise: 20.0, seed: 1}}
    - {label: fem 20 2, class: fem, level: 20.0, operator: fem, image: {noise: 20.0, seed: 2}}
    - {label: igl 20 0, class: libigl, level: 20.0, operator: libigl, image: {noise: 20.0, seed: 0}}
    - {label: igl 20 1, class: libigl, level: 20.0, operator: libigl, image: {noise: 20.0, seed: 1}}
    - {label: igl 20 2, class: libigl, level: 20.0, operator: libigl, image: {noise: 20.0, seed: 2}}
variants:
  - grid: {operator: [fem, libigl], image.noise: [10.0, 20.0], image.seed: [0, 1, 2]}
  - operator: fem
    image: {noise: 10.0, seed: 0}
    figures: [{name: sweep, metric: rmse, x_label: noise, inputs: {solvers: {dataset: noises}}}]
claims:
  - claim: Twice the noise gives at most thrice the error
    quantity: {ratio: rmse}
    rows: [{image.noise: 20.0}, {image.noise: 10.0}]
    between: [0, 3]
"""


def planned(folder: Path, name: str, text: str) -> Plan:
    file = folder / "conf" / "experiment" / f"{name}.yaml"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    plans: list[Plan] = []
    plan_and_act([f"experiment={name}"], plans.append)
    return plans[0]


def test_short_and_long_are_one_experiment(working_folder: Path) -> None:
    short, long = planned(working_folder, "short", SHORT), planned(working_folder, "long", LONG)
    assert {leaf.key for leaf in short.leaves} == {leaf.key for leaf in long.leaves} and len(short.leaves) == 12
    kinds = ("surface", "image", "operator", "solver")
    assert {k for k, node in short.nodes.items() if node.kind in kinds} == {
        k for k, node in long.nodes.items() if node.kind in kinds
    }
    assert short.settings.claims == long.settings.claims and short.settings.experiment == "short"
    drawn = [[plan.nodes[key] for leaf in plan.leaves for key in leaf.figures] for plan in (short, long)]
    assert [len(figures) for figures in drawn] == [1, 1]
    members = [sorted(dict.fromkeys(figures[0].children)) for figures in drawn]
    assert members[0] == members[1]


@pytest.mark.parametrize("name", sorted(experiments()))
def test_a_file_that_spells_all_is_left_as_it_is(name: str) -> None:
    text = experiments()[name].read_text(encoding="utf-8")
    document = yaml.safe_load(text)
    before = copy.deepcopy(document)
    if text.startswith("# @package _global_"):
        found = written_out(document)
        assert {key: value for key, value in found.items() if key != "target"} == {
            key: value for key, value in before.items() if key != "target"
        }
        assert found.get("target", "solver") == before.get("target", "solver")
    assert document == before


def test_parts_are_inputs_by_name() -> None:
    inputs = {"inputs": {"source": "left", "target": "right"}}
    right = {"surface": {"name": "icosphere", "levels": 3}}
    given = {
        "parts": {"left": {}, "right": right},
        "distance": {"name": "embedding_map", **inputs},
        "variants": [{"grid": {"distance": [{"name": "zoomout", **inputs}]}}],
    }
    found = written_out(given)
    assert found["distance"] == {"name": "embedding_map", "inputs": {"source": {}, "target": right}}
    assert found["variants"][0]["grid"]["distance"][0]["inputs"]["target"] == right
    assert found["target"] == "distance" and "parts" not in found


def labels(items: list[dict[str, Any]]) -> list[str]:
    return [item["label"] for item in items]


def test_an_item_with_a_grid_stands_for_many() -> None:
    item = {
        "grid": {"surface.structure": ["caudate", "putamen"], "surface.donor": ["9861", "10021"]},
        "class": "surface.structure",
        "group": "surface.donor",
    }
    given = {"surface": {"name": "subcortical", "hemisphere": "left"}, "datasets": {"shapes": [item]}}
    shapes = written_out(given)["datasets"]["shapes"]
    assert labels(shapes) == ["caudate 9861", "caudate 10021", "putamen 9861", "putamen 10021"]
    surface = {"name": "subcortical", "hemisphere": "left", "structure": "putamen", "donor": "9861"}
    assert shapes[2] == {"label": "putamen 9861", "class": "putamen", "group": "9861", "surface": surface}


def test_an_item_with_seeds_stands_for_each_and_beside_others() -> None:
    items = [{"label": "one", "surface": "cup"}, {"repeat": {"surface.seed": 3}}, {"surface": "torus"}]
    found = written_out({"surface": "callosum", "datasets": {"group": items}})["datasets"]["group"]
    assert labels(found) == ["one", "seed 0", "seed 1", "seed 2", "2"]
    assert [item["surface"] for item in found[1:4]] == [{"name": "callosum", "seed": seed} for seed in range(3)]


def test_stages_beside_a_grid_hold_for_all_its_items() -> None:
    item = {"grid": {"surface.pose": [1, 2]}, "surface": {"name": "articulated", "body": "heavy_biped"}}
    cup = {"name": "cup", "vertices": 4000}
    (_, second) = written_out({"surface": cup, "datasets": {"poses": [item]}})["datasets"]["poses"]
    assert second == {"label": "pose 2", "surface": {"name": "articulated", "body": "heavy_biped", "pose": 2}}
    bodies = {"grid": {"surface.body": ["heavy_biped"], "surface.pose": [1]}, "class": "surface.body"}
    (body,) = written_out({"surface": "articulated", "datasets": {"bodies": [bodies]}})["datasets"]["bodies"]
    assert (body["label"], body["class"]) == ("heavy biped 1", "heavy biped")
    assert body["surface"]["body"] == "heavy_biped"


def test_several_grids_are_told_apart_by_a_word() -> None:
    noise = {"grid": {"image.noise": [10, 20]}, "level": "image.noise"}
    items = [noise | {"class": "linear", "operator": "fem"}, noise | {"class": "other", "operator": "libigl"}]
    found = written_out({"image": "picture", "datasets": {"noise": items}})["datasets"]["noise"]
    assert labels(found) == ["linear noise 10", "linear noise 20", "other noise 10", "other noise 20"]
    image = {"name": "picture", "noise": 20}
    assert found[-1] == {
        "label": "other noise 20", "class": "other", "level": 20.0, "operator": {"name": "libigl"}, "image": image
    }  # fmt: skip


def test_a_part_may_be_made_of_a_part_before_it() -> None:
    parts = {
        "right": {"surface": {"name": "fsaverage5", "hemisphere": "right"}},
        "hidden": {"surface": {"name": "disguised", "inputs": {"original": "right"}}},
    }
    distance = {"name": "embedding_map", "inputs": {"target": "hidden"}}
    found = written_out({"parts": parts, "distance": distance})["distance"]["inputs"]["target"]
    assert found["surface"]["inputs"]["original"] == {"surface": {"name": "fsaverage5", "hemisphere": "right"}}


def test_a_claim_has_ten_keys() -> None:
    assert len(Claim.model_fields) == 10
    body = {"claim": "It is small", "quantity": {"max": "rmse"}, "between": [None, 2]}
    (claim,) = read_claims([body | {"published": {"table 2.1": "2"}, "because": "It says so."}])
    assert (claim.summary, claim.metric, claim.place, claim.value) == ("max", "rmse", ("table", "2.1"), "2")
    (ours,) = read_claims([body])
    assert ours.place is None and ours.source == "ours" and ours.reason == "No reason is given."


def test_the_file_names_the_experiment() -> None:
    composed = {"results": "there", "surface": None, "experiment": {"title": "T", "surface": "cup"}}
    assert named(composed, "mine") == {"results": "there", "surface": "cup", "title": "T", "experiment": "mine"}
    assert named({"experiment": "old", "title": "T"}, "new") == {"experiment": "old", "title": "T"}


SWEEP = """\
title: A sweep?
surface: {name: icosphere, levels: 1}
image: {name: two_phase, noise: 10.0}
model: rof
solver: primal_dual
grid: {image.noise: [10.0, 20.0, 40.0], operator: [fem, vertex_averaged]}
repeat: {image.seed: 3}
figures: [{name: sweep, metric: rmse, against: image.noise}]
"""


def test_a_sweep_over_a_grid_of_one_option_is_one_line() -> None:
    """With seeds repeated: mean and range at each place, not a line for each member."""
    given = {"grid": {"image.noise": [10.0, 20.0]}, "repeat": {"image.seed": 3}, "image": "two_phase"}
    for more, lines in (({}, {"rmse"}), ({"operator": ["fem", "libigl"]}, {"fem", "libigl"})):
        grid = given["grid"] | more
        figure = {"name": "sweep", "metric": "rmse", "against": "image.noise"}
        (items,) = written_out(given | {"grid": grid, "figures": [figure]})["datasets"].values()
        assert {item["class"] for item in items} == lines
        assert {item["level"] for item in items} == {10.0, 20.0}


@pytest.mark.parametrize(
    ("override", "kind", "left"),
    [
        ("operator=fem", "operator", {"fem"}),
        ("image.noise=20", "image", {20.0}),
        ("image.seed=5", "image", {10.0, 20.0, 40.0}),
        ("solver=newton", "operator", None),
    ],
)
def test_what_is_drawn_over_the_grid_follows_the_command_line(
    working_folder: Path, override: str, kind: str, left: set[Any] | None
) -> None:
    planned(working_folder, "sweep", SWEEP)
    if left is None:
        with pytest.raises(UserError, match="'newton' does not solve model 'rof' with a vertex-averaged operator"):
            plan_and_act(["experiment=sweep", override], [].append)
        return
    plans: list[Plan] = []
    plan_and_act(["experiment=sweep", override], plans.append)
    nodes = [node for node in plans[0].nodes.values() if node.kind == kind]
    assert {node.plugin if kind == "operator" else node.options["noise"] for node in nodes} == left
    assert any(node.kind == "figure" for node in plans[0].nodes.values())
    if override == "image.seed=5":
        assert {node.options["seed"] for node in nodes} == {5}


SWEPT = {"name": "sweep", "metric": "rmse", "against": "a"}
MISTAKES: dict[str, tuple[dict[str, Any], str]] = {
    "results": ({"experiment": {"results": "/"}}, "'results' is no part of an experiment"),
    "hydra": ({"experiment": {"hydra": {}}}, "'hydra' is no part of an experiment; .*@package _global_"),
    "name": ({"experiment": {"experiment": "other"}}, "it calls itself 'other'"),
    "parts": ({"parts": ["a"]}, "parts is .*names with stages"),
    "part": ({"parts": {"left": {}}, "distance": {"inputs": {"source": "lef"}}}, "'lef' is no part.*'left'"),
    "repeat": ({"repeat": 3}, "repeat is .3., seeds"),
    "times": ({"repeat": {"image.seed": 0}}, "'image.seed' is 0"),
    "truth": ({"repeat": {"image.seed": True}}, "is True"),
    "no seed": ({"repeat": {"image.noise": 3}}, "'image.noise' is no seed"),
    "against": (
        {"grid": {"image.noise": [1]}, "figures": [{"name": "sweep", "metric": "rmse", "against": "image.nois"}]},
        "did you mean 'image.noise'",
    ),
    "of what": (
        {"grid": {"image.noise": [1]}, "figures": [{"name": "sweep", "against": "image.noise"}]},
        "metric: METRIC is missing",
    ),
    "variants": (
        {"variants": [{}], "grid": {"a": [1]}, "figures": [{"name": "sweep", "metric": "x", "against": "a"}]},
        "variants",
    ),
    "grid": ({"datasets": {"a": [{"grid": {"surface.x": 3}}]}}, "grid is .* options with lists of values"),
    "fact": ({"datasets": {"a": [{"grid": {"surface.x": [1]}, "klass": "surface.x"}]}}, "did you mean 'class'"),
    "fact of": (
        {"datasets": {"a": [{"grid": {"surface.x": [1]}, "class": "surface.y"}]}},
        "did you mean 'surface.x'",
    ),
    "level": ({"datasets": {"a": [{"grid": {"surface.x": ["b"]}, "level": "surface.x"}]}}, "the level is 'b'"),
    "level word": ({"datasets": {"a": [{"grid": {"surface.x": [1]}, "level": "high"}]}}, "the level is 'high'"),
    "stage": ({"datasets": {"a": [{"grid": {"surfaces.x": [1]}}]}}, "did you mean 'surface'"),
    "seed": ({"datasets": {"a": [{"repeat": {"surface.x": 2}}]}}, "'surface.x' is no seed"),
    "figures": ({"figures": 3}, "a list of figures"),
    "claims": ({"claims": {"a": 1}}, "a list of claims"),
    "datasets": ({"datasets": [1]}, "lists of items by name"),
    "dataset": ({"datasets": {"a": 1}}, "a list of items"),
    "item": ({"datasets": {"a": [1]}}, "a list of items"),
    "text": ({"grid": {3: [1]}}, "key 3 is no text"),
}


@pytest.mark.parametrize("given", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_refused_with_its_name(given: tuple[dict[str, Any], str]) -> None:
    configuration, said = given
    with pytest.raises(UserError, match=said):
        written_out(named(configuration, "mine"))


@pytest.mark.parametrize(
    ("items", "said"),
    [
        ([{"label": "cup", "surface": "torus"}, {"label": "cup", "class": "a"}], "2 items are called 'cup'"),
        ([{"label": "1"}, {"surface": "torus"}], "2 items are called '1'"),
        ([{"label": 7}, {"label": "7"}], "2 items are called '7'"),
        ([{"grid": {"surface.x": [1]}}] * 2, "2 items are called 'x 1'.*tell grids apart"),
        ([{"grid": {"surface.x": [1, 1]}}], "leave out one of two equal values"),
    ],
)
def test_items_of_one_label_are_refused_however_they_are_written(items: list[dict[str, Any]], said: str) -> None:
    with pytest.raises(UserError, match=f"dataset a: .*{said}"):
        settings_of(written_out({"datasets": {"a": items}}))
    with pytest.raises(UserError, match="dataset a"):  # in a variant, whose datasets are those of its own rows
        settings_of(expand({"variants": [{"datasets": written_out({"datasets": {"a": items}})["datasets"]}]})[0])


PAGE = Path(__file__).resolve().parents[2] / "docs" / "experiments.md"


@pytest.mark.parametrize(("block", "rows"), [(0, 18), (1, 1), (2, 1), (3, 1)])
def test_the_experiments_of_the_page_can_be_planned(working_folder: Path, block: int, rows: int) -> None:
    text = re.findall(r"^```yaml\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[block]
    assert len(planned(working_folder, "page", text).leaves) == rows
