"""The short forms of an experiment say what the long ones say: same stages, same rows, same claims."""

from __future__ import annotations

import copy
import re
from pathlib import Path
from typing import Any, get_args

import pytest
import yaml

from surfexp.commands.request import plan_and_act
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.claim import Claim, read_claims
from surfexp.lab.experiment.statements import BELOW, QUANTITIES
from surfexp.lab.experiment.written_out import named, written_out
from surfexp.lab.plan.plan import Plan
from surfexp.lab.registry.folders import experiments

SHORT = """
title: Does the error grow with the noise?
surface: {icosphere: {levels: 3}}
image: {two_phase: {}}
model: rof
solver: {primal_dual: {tolerance: 1.0e-3}}
grid: {image.noise: [10.0, 20.0], operator: [fem, {libigl: {}}]}
repeat: {image.seed: 3}
figures: [{sweep: rmse, against: image.noise}]
claims:
  - Twice the noise gives at most thrice the error:
      ratio: {metric: rmse, of: {image.noise: 20.0}, to: {image.noise: 10.0}}
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
axes:
  noises:
    fem 10 0: {class: fem, level: 10.0, operator: fem, image: {noise: 10.0, seed: 0}}
    fem 10 1: {class: fem, level: 10.0, operator: fem, image: {noise: 10.0, seed: 1}}
    fem 10 2: {class: fem, level: 10.0, operator: fem, image: {noise: 10.0, seed: 2}}
    igl 10 0: {class: libigl, level: 10.0, operator: libigl, image: {noise: 10.0, seed: 0}}
    igl 10 1: {class: libigl, level: 10.0, operator: libigl, image: {noise: 10.0, seed: 1}}
    igl 10 2: {class: libigl, level: 10.0, operator: libigl, image: {noise: 10.0, seed: 2}}
    fem 20 0: {class: fem, level: 20.0, operator: fem, image: {noise: 20.0, seed: 0}}
    fem 20 1: {class: fem, level: 20.0, operator: fem, image: {noise: 20.0, seed: 1}}
    fem 20 2: {class: fem, level: 20.0, operator: fem, image: {noise: 20.0, seed: 2}}
    igl 20 0: {class: libigl, level: 20.0, operator: libigl, image: {noise: 20.0, seed: 0}}
    igl 20 1: {class: libigl, level: 20.0, operator: libigl, image: {noise: 20.0, seed: 1}}
    igl 20 2: {class: libigl, level: 20.0, operator: libigl, image: {noise: 20.0, seed: 2}}
variants:
  - grid: {operator: [fem, libigl], image.noise: [10.0, 20.0], image.seed: [0, 1, 2]}
  - operator: fem
    image: {noise: 10.0, seed: 0}
    figures: [{name: sweep, metric: rmse, x_label: noise, inputs: {solvers: {over: noises}}}]
claims:
  - claim: Twice the noise gives at most thrice the error
    quantity: ratio
    metric: rmse
    rows: {image.noise: 20.0}
    over: {image.noise: 10.0}
    between: [0, 3]
    because: No reason is given.
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
def test_a_file_without_short_forms_is_left_as_it_is(name: str) -> None:
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
    given = {
        "parts": {"left": {}, "right": {"surface": {"icosphere": {"levels": 3}}}},
        "distance": {"embedding_map": inputs},
        "variants": [{"grid": {"distance": [{"name": "zoomout", **inputs}]}}],
    }
    right = {"surface": {"name": "icosphere", "levels": 3}}
    found = written_out(given)
    assert found["distance"] == {"name": "embedding_map", "inputs": {"source": {}, "target": right}}
    assert found["variants"][0]["grid"]["distance"][0]["inputs"]["target"] == right
    assert found["target"] == "distance" and "parts" not in found


def test_an_axis_may_be_a_product() -> None:
    axis = {
        "product": {"surface.structure": ["caudate", "putamen"], "surface.donor": ["9861", "10021"]},
        "class": "surface.structure",
        "group": "surface.donor",
    }
    found = written_out({"surface": {"subcortical": {"hemisphere": "left"}}, "axes": {"shapes": axis}})
    shapes = found["axes"]["shapes"]
    assert list(shapes) == ["caudate 9861", "caudate 10021", "putamen 9861", "putamen 10021"]
    surface = {"name": "subcortical", "hemisphere": "left", "structure": "putamen", "donor": "9861"}
    assert shapes["putamen 9861"] == {"class": "putamen", "group": "9861", "surface": surface}


def test_stages_beside_a_product_hold_for_all_its_members() -> None:
    axis = {"product": {"surface.pose": [1, 2]}, "surface": {"articulated": {"body": "heavy_biped"}}}
    found = written_out({"surface": {"cup": {"vertices": 4000}}, "axes": {"poses": axis}})["axes"]["poses"]
    assert found["pose 2"] == {"surface": {"name": "articulated", "body": "heavy_biped", "pose": 2}}
    bodies = {"product": {"surface.body": ["heavy_biped"], "surface.pose": [1]}, "class": "surface.body"}
    found = written_out({"surface": "articulated", "axes": {"bodies": bodies}})["axes"]["bodies"]
    assert list(found) == ["heavy biped 1"] and found["heavy biped 1"]["class"] == "heavy biped"
    assert found["heavy biped 1"]["surface"]["body"] == "heavy_biped"


def test_an_axis_may_be_several_products_told_apart_by_a_word() -> None:
    noise = {"product": {"image.noise": [10, 20]}, "level": "image.noise"}
    axis = [noise | {"class": "linear", "operator": "fem"}, noise | {"class": "other", "operator": "libigl"}]
    found = written_out({"image": "picture", "axes": {"noise": axis}})["axes"]["noise"]
    assert list(found) == ["linear noise 10", "linear noise 20", "other noise 10", "other noise 20"]
    member = {
        "class": "other",
        "level": 20.0,
        "operator": {"name": "libigl"},
        "image": {"name": "picture", "noise": 20},
    }
    assert found["other noise 20"] == member


def test_values_of_a_product_may_be_a_range_with_both_ends() -> None:
    axis = {"product": {"surface.seed": {"from": 100, "to": 115}}}
    found = written_out({"surface": "callosum", "axes": {"group": axis}})["axes"]["group"]
    assert [member["surface"]["seed"] for member in found.values()] == list(range(100, 116))


def test_a_part_may_be_made_of_a_part_before_it() -> None:
    parts = {
        "right": {"surface": {"fsaverage5": {"hemisphere": "right"}}},
        "hidden": {"surface": {"disguised": {"inputs": {"original": "right"}}}},
    }
    distance = {"embedding_map": {"inputs": {"target": "hidden"}}}
    found = written_out({"parts": parts, "distance": distance})["distance"]["inputs"]["target"]
    assert found["surface"]["inputs"]["original"] == {"surface": {"name": "fsaverage5", "hemisphere": "right"}}


def test_an_axis_may_be_the_grid() -> None:
    given: dict[str, Any] = {"solver": "newton", "grid": {"model.weight": [0.5, 1]}}
    found = written_out(given | {"axes": {"weights": {"product": "grid", "level": "model.weight"}}})
    assert [member["level"] for member in found["axes"]["weights"].values()] == [0.5, 1.0]


def test_a_statement_that_is_too_long_for_a_key_stands_beside_its_quantity() -> None:
    body = {"max": {"metric": "rmse", "of": {"operator.name": "fem"}}, "between": [0, 3], "because": "It says so."}
    long, short = written_out({"claims": [{"claim": "It is small", **body}, {"It is small": body}]})["claims"]
    assert long == short and long["rows"] == {"operator.name": "fem"}


def test_the_words_of_claims_are_those_that_claims_have() -> None:
    assert get_args(Claim.model_fields["quantity"].annotation) == QUANTITIES
    assert set(BELOW) == set(Claim.model_fields) - {"claim", "quantity", "metric", "rows", "over"}
    body = {"max": "rmse", "between": [None, 2], "published": {"table": "2.1", "value": "2"}, "because": "It says so."}
    (claim,) = read_claims(written_out({"claims": [{"It is small": body}]})["claims"])
    assert (claim.claim, claim.quantity, claim.metric, claim.because) == ("It is small", "max", "rmse", "It says so.")


def test_what_others_published_needs_a_reason() -> None:
    body = {"max": "rmse", "between": [None, 2], "reference": "Somebody (2020)"}
    with pytest.raises(UserError, match="'because' is missing"):
        read_claims(written_out({"claims": [{"It is small": body}]})["claims"])


def test_the_file_names_the_experiment() -> None:
    composed = {"results": "there", "surface": None, "experiment": {"title": "T", "surface": "cup"}}
    assert named(composed, "mine") == {"results": "there", "surface": "cup", "title": "T", "experiment": "mine"}
    assert named({"experiment": "old", "title": "T"}, "new") == {"experiment": "old", "title": "T"}


SWEEP = """\
title: A sweep?
surface: {icosphere: {levels: 1}}
image: {two_phase: {noise: 10.0}}
model: rof
solver: primal_dual
grid: {image.noise: [10.0, 20.0, 40.0], operator: [fem, vertex_averaged]}
repeat: {image.seed: 3}
figures: [{sweep: rmse, against: image.noise}]
"""


def test_a_sweep_over_a_grid_of_one_option_is_one_line() -> None:
    """With seeds repeated: mean and range at each place, not a line for each member."""
    given = {"grid": {"image.noise": [10.0, 20.0]}, "repeat": {"image.seed": 3}, "image": "two_phase"}
    for more, lines in (({}, {"rmse"}), ({"operator": ["fem", "libigl"]}, {"fem", "libigl"})):
        grid = given["grid"] | more
        found = written_out(given | {"grid": grid, "figures": [{"sweep": "rmse", "against": "image.noise"}]})
        (members,) = found["axes"].values()
        assert {member["class"] for member in members.values()} == lines
        assert {member["level"] for member in members.values()} == {10.0, 20.0}


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
        {"grid": {"image.noise": [1]}, "figures": [{"sweep": "rmse", "against": "image.nois"}]},
        "did you mean 'image.noise'",
    ),
    "of what": ({"grid": {"image.noise": [1]}, "figures": [{"against": "image.noise"}]}, "sweep: METRIC is missing"),
    "variants": ({"variants": [{}], "grid": {"a": [1]}, "figures": [{"sweep": "x", "against": "a"}]}, "variants"),
    "product": ({"axes": {"a": {"product": 3}}}, "product is 3"),
    "fact": ({"axes": {"a": {"product": {"surface.x": [1]}, "klass": "surface.x"}}}, "did you mean 'class'"),
    "fact of": ({"axes": {"a": {"product": {"surface.x": [1]}, "class": "surface.y"}}}, "did you mean 'surface.x'"),
    "level": ({"axes": {"a": {"product": {"surface.x": ["b"]}, "level": "surface.x"}}}, "the level is 'b'"),
    "stage": ({"axes": {"a": {"product": {"surfaces.x": [1]}}}}, "did you mean 'surface'"),
    "mixed": (
        {"axes": {"a": [{"product": {"surface.x": [1]}}, {"surface": "cup"}]}},
        "products and members do not mix",
    ),
    "labels": ({"axes": {"a": [{"product": {"surface.x": [1]}}] * 2}}, "two members are 'x 1'"),
    "values": ({"axes": {"a": {"product": {"surface.x": [1, 1]}}}}, "leave one of two equal values out"),
    "range": ({"axes": {"a": {"product": {"surface.x": {"from": 3, "to": 2}}}}}, "from 3 to 2 are 0 values"),
    "fractions": ({"axes": {"a": {"product": {"surface.x": {"from": 0.5, "to": 2}}}}}, "options with lists of values"),
    "level word": ({"axes": {"a": {"product": {"surface.x": [1]}, "level": "high"}}}, "the level is 'high'"),
    "quantities": ({"claims": [{"S": {"all": "x", "any": "x"}}]}, "all and any given"),
    "quantity": ({"claims": [{"S": {"between": [0, 1]}}]}, "no quantity given"),
    "key": ({"claims": [{"S": {"rato": "x"}}]}, "did you mean 'ratio'"),
    "of": ({"claims": [{"S": {"all": {"metrik": "x"}}}]}, "did you mean 'metric'"),
    "figures": ({"figures": 3}, "a list of figures"),
    "claims": ({"claims": {"a": 1}}, "a list of statements"),
    "axes": ({"axes": [1]}, "collections by name"),
    "axis": ({"axes": {"a": 1}}, "members by label"),
    "text": ({"grid": {3: [1]}}, "key 3 is no text"),
    "body": ({"claims": [{"S": 3}]}, "a quantity and an interval are needed"),
}


@pytest.mark.parametrize("given", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_refused_with_its_name(given: tuple[dict[str, Any], str]) -> None:
    configuration, said = given
    with pytest.raises(UserError, match=said):
        written_out(named(configuration, "mine"))


PAGE = Path(__file__).resolve().parents[2] / "docs" / "experiments.md"


@pytest.mark.parametrize(("block", "rows"), [(0, 18), (1, 1), (2, 1)])
def test_the_experiments_of_the_page_can_be_planned(working_folder: Path, block: int, rows: int) -> None:
    text = re.findall(r"^```yaml\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[block]
    assert len(planned(working_folder, "page", text).leaves) == rows
