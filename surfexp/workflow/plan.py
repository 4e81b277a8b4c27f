"""The plan: the smallest set of stages that a batch of configurations takes, each with its content-addressed key."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from surfexp.member import FACTS, axis_members
from surfexp.workflow.configuration import Context, Settings, merge, one_line, settings_of, stage
from surfexp.workflow.errors import UserError, check_known
from surfexp.workflow.fingerprint import code_digest, compiled_state, digest, file_digest
from surfexp.workflow.kinds import KINDS
from surfexp.workflow.registry import Plugin, load_file, names_of, plugin
from surfexp.workflow.store import write_text

Keys = str | list[str] | dict[str, str]


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
    """What one configuration asks for: the stage at the end of its chain, its figures, and how to show it."""

    key: str
    configuration: str
    settings: dict[str, Any]
    parameters: dict[str, Any]
    figures: list[str] = field(default_factory=list)


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

    def write(self, results: Path) -> Path:
        """Write the plan below the results folder; the same plan always gives the same file."""
        path = results / "plans" / f"{self.settings.experiment}-{self.identity}.json"
        write_text(path, json.dumps(asdict(self) | {"settings": self.settings.model_dump()}, indent=1))
        return path


def read_plan(path: Path) -> Plan:
    """Read a plan back from its file."""
    tree = json.loads(path.read_text())
    nodes = {key: Node(**node) for key, node in tree["nodes"].items()}
    return Plan(Settings(**tree["settings"]), nodes, [Leaf(**leaf) for leaf in tree["leaves"]], tree["requested"])


def load_own_kinds(plan: Plan) -> None:
    """Load the plugin files of a plan that was made elsewhere, if they declare a stage kind of their own."""
    if not KINDS.keys() >= {node.kind for node in plan.nodes.values()}:
        for file in {node.file for node in plan.nodes.values()}:
            load_file(Path(file))


def stored_inputs(nodes: Mapping[str, Node], key: str) -> list[str]:
    """Keys of the stored results that a stage reads, through the unstored stages (models) it makes itself."""
    found: dict[str, None] = {}
    for child in nodes[key].children:
        found.update(dict.fromkeys([child] if KINDS[nodes[child].kind].stored else stored_inputs(nodes, child)))
    return list(found)


def make_plan(configurations: Iterable[Context]) -> Plan:
    """Resolve leaf configurations into one plan; equal stages and equal leaves merge by key."""
    plan: Plan | None = None
    seen: dict[str, Leaf] = {}
    for configuration in configurations:
        settings = settings_of(configuration)
        plan = plan or Plan(settings)
        context = {kind: value for kind, value in configuration.items() if kind in KINDS and value is not None}
        resolver = _Resolver(plan, settings.axes)
        key = resolver.node(settings.target, context, ())
        leaf = Leaf(key, digest(_flat(plan, key)), settings.model_dump(), _flat(plan, key))
        for figure in settings.figures:
            leaf.figures.append(resolver.node("figure", merge(context, {"figure": figure}), ()))
        plan.requested += resolver.visits
        first = seen.setdefault(key, leaf)
        first.figures += [figure for figure in leaf.figures if figure not in first.figures]
    if plan is None:
        raise UserError("nothing to plan: the sweep is empty")
    plan.leaves += seen.values()
    return plan


@dataclass
class _Resolver:
    plan: Plan
    axes: Mapping[str, Any]
    visits: int = 0

    def node(self, kind: str, context: Context, path: tuple[str, ...]) -> str:
        """Resolve the stage of one kind in a context, its inputs first; return its key."""
        if context.get(kind) is None:
            wanted = f", wanted by {path[-1].split(' ')[0]}" if path else ""
            names = ", ".join(sorted(names_of(kind))) or "none registered"
            raise UserError(f"no {kind} is configured{wanted}; choose {kind}= one of: {names}")
        configured = stage(context[kind])
        if not configured.get("name"):
            raise UserError(f"{kind}: the plugin's name is missing; set {kind}=NAME")
        method = plugin(kind, str(configured.pop("name")))
        overrides = configured.pop("inputs", None) or {}
        here = f"{kind}/{method.name} {digest([kind, context])}"
        if here in path:
            raise UserError(f"cycle: {' -> '.join(step.split(' ')[0] for step in (*path[path.index(here) :], here))}")
        options = _checked_options(method, configured)
        check_known(f"input of {kind}/{method.name}", overrides, method.inputs)
        inputs = {
            role: self._input(method, role, context, dict(overrides.get(role) or {}), (*path, here))
            for role in method.inputs
        }
        return self._add(method, options, inputs)

    def _input(self, method: Plugin, role: str, context: Context, override: Context, path: tuple[str, ...]) -> Any:
        wanted = method.inputs[role]
        axis = override.pop("over", None)
        check_known(f"stage kind below inputs.{role} of {method.kind}/{method.name}", override, KINDS)
        context = merge(context, override)
        if wanted.shape == "one":
            key, where = self.node(wanted.kind, context, path), f"{method.kind}/{method.name}"
            name = self.plan.nodes[key].plugin
            allowed = method.accepts.get(wanted.kind, (name,))
            if name not in allowed:
                raise UserError(f"{where} takes no {wanted.kind} {name!r}; it takes: {', '.join(allowed)}")
            return key
        check_known(f"axis of list input {role!r} of {method.kind}/{method.name} (over)", [str(axis)], self.axes)
        members = axis_members(self.axes[axis])
        check_known(f"key of a member of axis {axis!r}", sorted(set().union(*members.values())), (*KINDS, *FACTS))
        keys = {member: self.node(wanted.kind, merge(context, part), path) for member, part in members.items()}
        named = {member.label: key for member, key in keys.items()}
        return {"members": keys, "dict": named, "list": list(keys.values())}[wanted.shape]

    def _add(self, method: Plugin, options: dict[str, Any], wired: dict[str, Any]) -> str:
        self.visits += KINDS[method.kind].stored
        function, where = method.function.__qualname__, str(method.file)
        code, cache = code_digest(method.file, function), compiled_state(method.file)
        paths = {name for name, item in method.options.model_fields.items() if "Path" in str(item.annotation)}
        named = {name: options[name] for name in paths if options.get(name) is not None}
        files = {name: _digest_of(path) for name, path in _file_options(named).items()}
        rest = {name: value for name, value in options.items() if name not in named}
        asked = {role: keys for role, keys in wired.items() if method.inputs[role].shape == "members"}
        members = {role: [asdict(member) for member in keys] for role, keys in asked.items()}
        inputs = wired | {role: {member.label: key for member, key in keys.items()} for role, keys in asked.items()}
        key = digest([method.kind, method.name, {**rest, **files}, inputs, members, code])
        node = Node(key, method.kind, method.name, where, code, cache, options, inputs, files, members, function)
        self.plan.nodes[key] = node
        return key


def _checked_options(method: Plugin, configured: Context) -> dict[str, Any]:
    where = f"{method.kind}/{method.name}"
    check_known(f"option of {where}", configured, method.options.model_fields)
    given = {name: value for name, value in configured.items() if value != "???"}
    try:
        return method.options(**given).model_dump(mode="json")
    except ValidationError as error:
        raise UserError(one_line(where, error)) from None


def _file_options(options: Mapping[str, Any]) -> dict[str, Path]:
    """The files that options name, by option: one, or several by a name of their own ("maps.sulc")."""
    found: dict[str, Path] = {}
    for option, value in options.items():
        several = isinstance(value, Mapping)
        found |= {f"{option}.{key}": Path(path) for key, path in value.items()} if several else {option: Path(value)}
    return found


def _digest_of(path: Path) -> str:
    if not path.exists():
        raise UserError(f"file {str(path)!r} does not exist")
    return file_digest(path.resolve())


def _members(value: Any) -> dict[str, Any]:
    members = [value] if isinstance(value, str) else value
    return dict(members if isinstance(members, Mapping) else enumerate(members))


def _flat(plan: Plan, key: str, root: str = "") -> dict[str, Any]:
    """All options upstream; those of a collection once, with the number of values where its members differ."""
    flat: dict[str, Any] = {}
    owners: dict[str, str] = {}

    def visit(key: str, prefix: str, parent: str) -> None:
        node = plan.nodes[key]
        if owners.get(prefix, key) != key:
            prefix = f"{parent}.{prefix}"
        if owners.setdefault(prefix, key) == key and f"{prefix}.name" not in flat:
            flat[f"{prefix}.name"] = node.plugin
            flat.update({f"{prefix}.{name}": value for name, value in node.options.items()})
        for role, value in node.inputs.items():
            if isinstance(value, str):
                visit(value, role, prefix)
                continue
            parts = [_flat(plan, child, role) for child in _members(value).values()]
            for name in dict.fromkeys(name for part in parts for name in part):
                values = list(dict.fromkeys(json.dumps(part.get(name)) for part in parts))
                varied = f"{len(values)} values ({digest(values)[:6]})"
                flat.setdefault(name, parts[0][name] if len(values) == 1 else varied)

    visit(key, root or plan.nodes[key].kind, "")
    return flat
