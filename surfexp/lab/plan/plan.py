"""The plan: the stages that a batch of configurations takes, its leaves, and the file that holds them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from surfexp.lab.digests import digest
from surfexp.lab.errors import unknown
from surfexp.lab.experiment.configuration import Settings
from surfexp.lab.experiment.former_spelling import present_settings
from surfexp.lab.store.kinds import KINDS
from surfexp.lab.store.store import write_text

Keys = str | list[str] | dict[str, str]
ORDER = Path("plans", "order.txt")


@dataclass(frozen=True)
class Node:
    """One stage of a plan: a plugin, its code and compilation cache, its checked options, its inputs' keys by role.

    `files` holds the digest, when planned, of each file that an option names. Facts about the members of a collection stand beside
    its keys, for inputs that ask for them.
    """

    key: str
    kind: str
    plugin: str
    file: str
    code: str
    cache: str
    options: dict[str, Any]
    inputs: dict[str, Keys]
    files: dict[str, str] = field(default_factory=dict)
    members: dict[str, list[dict[str, Any]]] = field(default_factory=dict)
    function: str = ""

    @property
    def children(self) -> list[str]:
        """Keys of all inputs."""
        return [child for value in self.inputs.values() for child in _members(value).values()]


@dataclass
class Leaf:
    """What one configuration asks for: the stage at the end of its chain, a digest of its options, its figures.

    `settings` say how to show it; leaves share them where they agree. `also` are those of other tables that ask for it, each
    with the number of leaves that stand before it there.
    """

    key: str
    configuration: str
    settings: dict[str, Any]
    figures: list[str] = field(default_factory=list)
    also: list[tuple[int, dict[str, Any]]] = field(default_factory=list)

    @property
    def shown(self) -> list[dict[str, Any]]:
        """Its settings in each table that it stands in."""
        return [self.settings, *(settings for _, settings in self.also)]

    def ask_again(self, place: int, settings: dict[str, Any]) -> None:
        """Note that another table asks for it too, after `place` other leaves."""
        if settings["comparison"] not in [known["comparison"] for known in self.shown]:
            self.also.append((place, settings))


@dataclass
class Plan:
    """All stages of a batch, shared where their keys agree, and the leaves in the order in which they were asked for."""

    settings: Settings
    nodes: dict[str, Node] = field(default_factory=dict)
    leaves: list[Leaf] = field(default_factory=list)
    requested: int = 0

    @property
    def stored(self) -> list[Node]:
        """The stages that Snakemake runs: those whose results are kept."""
        return [node for node in self.nodes.values() if KINDS[node.kind].stored]

    @property
    def identity(self) -> str:
        """Digest of the set of leaves and figures."""
        return digest(sorted({key for leaf in self.leaves for key in (leaf.key, *leaf.figures)}))

    def parameters(self, leaf: Leaf) -> dict[str, Any]:
        """The plugins' names and all options of a leaf and of the stages before it."""
        return flat_parameters(self.nodes, leaf.key)

    def write(self, results: Path) -> Path:
        """Write the plan below the results folder, as the latest one there."""
        path = results / "plans" / f"{self.settings.experiment}-{self.identity}.json"
        write_text(path, self.text())
        earlier = [file.name for file in plans_by_age(results) if file != path]
        write_text(results / ORDER, "\n".join([*earlier, path.name]))
        return path

    def text(self) -> str:
        """The plan as it is written: what all share, the leaves, and each stage on a line of its own."""
        shown = {id(settings): settings for leaf in self.leaves for settings in leaf.shown}
        numbers = {identity: number for number, identity in enumerate(shown)}
        leaves = [
            vars(leaf)
            | {"settings": numbers[id(leaf.settings)]}
            | {"also": [(place, numbers[id(settings)]) for place, settings in leaf.also]}
            for leaf in self.leaves
        ]
        head = {"settings": self.settings.model_dump(), "requested": self.requested, "shown": list(shown.values())}
        return "\n".join(map(json.dumps, (head, leaves, *map(vars, self.nodes.values()))))


def read_plan(path: Path, key: str = "") -> Plan:
    """Read a plan back; with a key only that stage, those before it and no leaves, since each stage's process reads it."""
    text = path.read_text()
    head, *lines = text.split("\n")
    tree = json.loads(text if head == "{" else head)
    if "shown" not in tree:
        return _of_one_document(tree)
    leaves, nodes = lines[0], {line[9:29]: line for line in lines[1:]}
    plan = Plan(_settings(tree["settings"]), requested=tree["requested"])
    shown = tree["shown"]
    for leaf in [] if key else json.loads(leaves):
        also = [(place, shown[number]) for place, number in leaf.get("also", ())]
        plan.leaves.append(Leaf(**leaf | {"settings": shown[leaf["settings"]], "also": also}))
    waiting = [key] if key else list(reversed(nodes))
    while waiting:
        if (one := waiting.pop()) not in plan.nodes:
            plan.nodes[one] = Node(**json.loads(nodes[one]))
            waiting += plan.nodes[one].children
    return plan


def _of_one_document(tree: Mapping[str, Any]) -> Plan:
    """A plan as earlier versions wrote it, whose results are as good as ever: settings and options stand with each leaf."""
    nodes = {key: Node(**node) for key, node in tree["nodes"].items()}
    leaves = [Leaf(*map(leaf.get, ("key", "configuration", "settings", "figures"))) for leaf in tree["leaves"]]
    return Plan(_settings(tree["settings"]), nodes, leaves, tree["requested"])


def _settings(tree: Mapping[str, Any]) -> Settings:
    """The settings of a plan, perhaps of an earlier version, whose results are as good as ever."""
    return Settings(**present_settings(tree))


def stored_inputs(nodes: Mapping[str, Node], key: str) -> list[str]:
    """Keys of the stored results that a stage reads, through the unstored stages (models) it makes itself."""
    found: dict[str, None] = {}
    for child in nodes[key].children:
        found.update(dict.fromkeys([child] if KINDS[nodes[child].kind].stored else stored_inputs(nodes, child)))
    return list(found)


def _members(value: Any) -> dict[str, Any]:
    members = [value] if isinstance(value, str) else value
    return dict(members if isinstance(members, Mapping) else enumerate(members))


def flat_parameters(nodes: Mapping[str, Node], key: str, root: str = "") -> dict[str, Any]:
    """All options upstream; those of a collection once, with the number of values where its members differ."""
    flat: dict[str, Any] = {}
    owners: dict[str, str] = {}

    def visit(key: str, prefix: str, parent: str) -> None:
        node = nodes[key]
        if owners.get(prefix, key) != key:
            prefix = f"{parent}.{prefix}"
        if owners.setdefault(prefix, key) == key and f"{prefix}.name" not in flat:
            flat[f"{prefix}.name"] = node.plugin
            flat.update({f"{prefix}.{name}": value for name, value in node.options.items()})
        for role, value in node.inputs.items():
            if isinstance(value, str):
                visit(value, role, prefix)
                continue
            parts = [flat_parameters(nodes, child, role) for child in _members(value).values()]
            for name in dict.fromkeys(name for part in parts for name in part):
                values = list(dict.fromkeys(json.dumps(part.get(name)) for part in parts))
                varied = f"{len(values)} values ({digest(values)[:6]})"
                flat.setdefault(name, parts[0].get(name) if len(values) == 1 else varied)

    visit(key, root or nodes[key].kind, "")
    return flat


def plans_by_age(results: Path) -> list[Path]:
    """Files of the plans of a results folder, in the order in which they were written last.

    That stands in a file, since times of files change when the folder is copied. Plans of earlier versions, which are not in
    it, come first, by their times.
    """
    order = results / ORDER
    places = {name: place for place, name in enumerate(order.read_text().splitlines())} if order.is_file() else {}
    plans = (results / "plans").glob("*.json")
    return sorted(plans, key=lambda file: (places.get(file.name, -1), file.stat().st_mtime_ns))


def latest_plan(results: Path, experiment: str) -> Plan:
    """The plan of an experiment that was written last."""
    found = {file: file.stem.rpartition("-")[0] for file in plans_by_age(results)}
    mine = [file for file, name in found.items() if name == experiment]
    if not mine:
        raise unknown(f"finished experiment in {results}", experiment, set(found.values()))
    return read_plan(mine[-1])
