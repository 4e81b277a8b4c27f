"""Large plans: each stage is resolved once, each process reads its own part, and a request planned before is remembered."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest

from surfexp.lab.digests import file_digest
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan import code_digests, resolution
from surfexp.lab.plan import remembered_plans as planned
from surfexp.lab.plan.plan import Plan, read_plan
from surfexp.lab.plan.resolution import Resolver, make_plan
from surfexp.lab.registry import catalogue, registry
from surfexp.lab.registry.folders import package_folder

TOYS = Path(__file__).with_name("toy_plugins.py")


@pytest.fixture(autouse=True)
def toys() -> None:
    registry.load_file(TOYS)


def sweep(sizes: int, shifts: int) -> dict[str, Any]:
    """Distances between a feature of a feature and a feature: two inputs of one kind, a kind that recurs, an axis."""
    weight = {"scalar": {"name": "toy_boundary", "shift": 1.0}}
    source = {"scalar": "toy_eigenfunction", "weighted": {"name": "toy_flux", "inputs": {"weight": weight}}}
    spread = {"features": {"dataset": "subject"}, "named": {"dataset": "subject"}}
    distance = {"name": "toy_distance", "inputs": {"source": source, "target": {"surface": {"size": 3.0}}}}
    return {
        "target": "pairing",
        "surface": "toy_triangle",
        "scalar": "toy_boundary",
        "datasets": {
            "subject": [{"label": name, "scalar": {"shift": float(len(name))}} for name in ("a", "bb", "ccc")]
        },
        "variants": [
            {"title": "distances", "pairing": distance},
            {"title": "spreads", "pairing": {"name": "toy_spread", "inputs": spread}},
        ],
        "grid": {
            "surface.size": [1.0 + size for size in range(sizes)],
            "scalar.shift": [0.5 * shift for shift in range(shifts)],
        },
    }


def test_what_is_remembered_changes_nothing() -> None:
    leaves = expand(sweep(3, 4))
    together = make_plan(leaves)
    nodes: dict[str, Any] = {}
    requested = 0
    for leaf in leaves:
        alone = make_plan([leaf])
        nodes |= alone.nodes
        requested += alone.requested
        (one,) = alone.leaves
        (same,) = [item for item in together.leaves if item.key == one.key]
        assert alone.parameters(one) == together.parameters(same)
        assert one.configuration == same.configuration or alone.nodes[one.key].plugin == "toy_spread"
    assert together.nodes == nodes and together.requested == requested


def test_each_stage_is_resolved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    resolved = []
    original = Resolver.add

    def counted(self: Resolver, method: Any, *rest: Any) -> str:
        resolved.append(method.name)
        return original(self, method, *rest)

    monkeypatch.setattr(Resolver, "add", counted)
    configuration = sweep(5, 8)
    configuration["variants"] = configuration["variants"][:1]
    plan = make_plan(expand(configuration))
    assert len(plan.leaves) == 5 * 8 and len(resolved) == len(plan.nodes)


def test_settings_are_checked_once_for_leaves_that_share_them(monkeypatch: pytest.MonkeyPatch) -> None:
    checked = []
    original = resolution.settings_of
    monkeypatch.setattr(resolution, "settings_of", lambda given: checked.append(1) or original(given))
    plan = make_plan(expand(sweep(5, 8)))
    assert len(checked) == 2 and len({id(leaf.settings) for leaf in plan.leaves}) == 2


def test_a_plan_is_read_back_and_a_stage_reads_its_own_part(tmp_path: Path) -> None:
    plan = make_plan(expand(sweep(4, 6)))
    path = plan.write(tmp_path)
    again = read_plan(path)
    assert again == plan and list(again.nodes) == list(plan.nodes)
    assert again.write(tmp_path / "again").read_text() == path.read_text()
    for key in [plan.leaves[0].key, plan.leaves[-1].key]:
        part = read_plan(path, key)
        needed = {key}
        while more := {child for one in needed for child in plan.nodes[one].children} - needed:
            needed |= more
        assert part.nodes == {one: plan.nodes[one] for one in needed} and not part.leaves
        assert part.settings == plan.settings and len(needed) < len(plan.nodes) / 2


@pytest.mark.parametrize("indent", [None, 1])
def test_a_plan_of_an_earlier_version_is_read(tmp_path: Path, indent: int | None) -> None:
    plan = make_plan(expand(sweep(2, 2)))
    tree = asdict(plan) | {"settings": plan.settings.model_dump()}
    for leaf, item in zip(plan.leaves, tree["leaves"], strict=True):
        item["parameters"] = plan.parameters(leaf)
    file = tmp_path / "old.json"
    file.write_text(json.dumps(tree, indent=indent))
    assert read_plan(file) == plan


def test_the_nodes_of_other_stages_are_not_parsed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counts = {}
    original = json.loads
    for shifts in (4, 40):
        plan = make_plan(expand(sweep(1, shifts)))
        path = plan.write(tmp_path)
        parsed: list[int] = []
        monkeypatch.setattr(resolution.json, "loads", lambda text, into=parsed: into.append(1) or original(text))
        read_plan(path, plan.leaves[1].key)
        monkeypatch.setattr(resolution.json, "loads", original)
        counts[shifts] = len(parsed)
    assert counts[4] == counts[40]


@pytest.fixture
def cache(tmp_path: Path, working_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(planned, "user_cache", lambda part: tmp_path / "cache" / part)
    monkeypatch.setattr(catalogue, "open_catalogue", lambda folder: None)
    (tmp_path / "cache").mkdir(mode=0o700)
    return tmp_path / "cache"


def remembered(arguments: list[str]) -> Plan | None:
    return planned.remembered(planned.place(arguments))


def remember(arguments: list[str], plan: Plan) -> None:
    planned.remember(planned.place(arguments), plan)


def toy_plan() -> Plan:
    return make_plan(expand(sweep(2, 2)))


def test_the_plan_of_a_request_is_remembered(cache: Path) -> None:
    plan, arguments = toy_plan(), ["experiment=toys"]
    assert remembered(arguments) is None
    remember(arguments, plan)
    assert remembered(arguments) == plan
    assert remembered([*arguments, "surface.size=2"]) is None
    (kept,) = (cache / "plans").glob("*/plan.json")
    data = bytearray(kept.read_bytes())
    data[len(data) // 2] ^= 1
    kept.write_bytes(bytes(data))
    assert remembered(arguments) is None
    remember(arguments, plan)
    assert remembered(arguments) == plan


def test_a_remembered_plan_is_not_used_when_anything_that_it_follows_from_changed(
    cache: Path, working_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, arguments = toy_plan(), ["experiment=toys"]
    file = working_folder / "mesh.off"
    file.write_text("OFF\n")
    leaf = plan.nodes[plan.leaves[0].key]
    leaf.options["path"] = str(file)
    leaf.files["path"] = file_digest(file)
    remember(arguments, plan)
    assert remembered(arguments) == plan
    file.write_text("OFF \n")
    file_digest.cache_clear()
    assert remembered(arguments) is None
    file.write_text("OFF\n")
    file_digest.cache_clear()
    assert remembered(arguments) == plan
    experiment = working_folder / "conf" / "experiment" / "mine.yaml"
    experiment.parent.mkdir(parents=True)
    experiment.write_text("title: mine\n")
    assert remembered(arguments) is None
    remember(arguments, plan)
    assert remembered(arguments) == plan
    experiment.write_text("title: ours\n")
    assert remembered(arguments) is None
    remember(arguments, plan)
    monkeypatch.setattr(planned, "code_state", lambda folder: "other code")
    assert remembered(arguments) is None


def test_the_code_of_plugins_outside_of_packages_is_read_again(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan, arguments = toy_plan(), ["experiment=toys"]
    remember(arguments, plan)
    assert remembered(arguments) == plan
    monkeypatch.setattr("surfexp.lab.plan.code_digests.code_digest", lambda file, function: "edited")
    assert remembered(arguments) is None


def test_a_method_of_ours_that_reaches_other_sources_is_read_again(
    cache: Path, working_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of an editable package, say, of which the state of the code does not know."""
    plan, arguments = toy_plan(), ["experiment=toys"]
    ours = package_folder("surfexp.plugins") / "surface" / "disk.py"
    plan.nodes = {key: replace(node, file=str(ours)) for key, node in plan.nodes.items()}
    for reached, methods in ((ours, 0), (working_folder / "helper.py", 1)):
        if reached != ours:
            reached.touch()
        monkeypatch.setattr(code_digests, "code_closure", lambda *_, reached=reached: ({reached}, set()))
        remember(arguments, plan)
        (kept,) = (cache / "plans").glob("*/kept.json")
        assert (len(json.loads(kept.read_text())["methods"]) > 0) == methods


@pytest.mark.parametrize("text", ["title: ${oc.env:USER}\n", "hydra: {searchpath: [file:///elsewhere]}\n"])
def test_a_request_that_asks_the_environment_is_planned_each_time(text: str, cache: Path, working_folder: Path) -> None:
    plan, arguments = toy_plan(), ["experiment=toys"]
    (working_folder / "conf").mkdir()
    (working_folder / "conf" / "mine.yaml").write_text(text)
    remember(arguments, plan)
    assert remembered(arguments) is None and not (cache / "plans").exists()
    for request in (["--multirun"], ["title=${now:%H}"]):
        remember(request, plan)
        assert remembered(request) is None


@pytest.mark.parametrize("name", ["subjects.csv", "shapes", "shapes/*.off", "'subjects.csv'", '"shapes/[ab]*.off"'])
@pytest.mark.parametrize("key", ["datasets", "+datasets.subject"])
def test_a_request_of_own_files_is_planned_again_when_its_items_are_others(
    key: str, name: str, cache: Path, working_folder: Path
) -> None:
    plan, arguments = toy_plan(), ["experiment=toys", f"{key}={name}"]
    table = working_folder / "subjects.csv"
    (working_folder / "shapes").mkdir()
    (working_folder / "shapes" / "a1.off").touch()
    table.write_text("path,class\nshapes/a1.off,round\n")
    remember(arguments, plan)
    assert remembered(arguments) == plan
    (working_folder / "shapes" / "b2.off").touch()
    table.write_text("path,class\nshapes/a1.off,long\n")
    assert remembered(arguments) is None


@pytest.mark.parametrize("value", ["a.csv,faces", "[a.csv]", "choice(a.csv,b.csv)", "missing.csv", r"'it\'s.csv'"])
def test_datasets_that_only_planning_reads_are_planned_each_time(value: str, cache: Path, working_folder: Path) -> None:
    remember(arguments := ["experiment=toys", f"datasets={value}"], toy_plan())
    assert remembered(arguments) is None
