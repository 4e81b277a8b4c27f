"""From configurations to a plan: the smallest set of stages, each with its content-addressed key."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from surfexp.contract.member import FACTS, members_of
from surfexp.lab.digests import digest, file_digest
from surfexp.lab.errors import UserError, check_known
from surfexp.lab.experiment.configuration import Context, merge, one_line, settings_of, stage
from surfexp.lab.plan.code_digests import code_digest, compiled_state
from surfexp.lab.plan.plan import Leaf, Node, Plan, flat_parameters
from surfexp.lab.registry.option_files import option_files
from surfexp.lab.registry.registry import Plugin, names_of, plugin
from surfexp.lab.store.kinds import KINDS


def make_plan(configurations: Iterable[Context]) -> Plan:
    """Resolve leaf configurations into one plan; equal stages and equal leaves merge by key."""
    plan: Plan | None = None
    seen: dict[str, Leaf] = {}
    before: Context = {}
    for configuration in configurations:
        if (top := {key: value for key, value in configuration.items() if key not in KINDS}) != before or plan is None:
            settings, before = settings_of(configuration), top
            _check_target(settings.target)
            plan, shown = plan or Plan(settings), settings.model_dump()
            resolver = Resolver(plan, settings.datasets)
        context = {kind: value for kind, value in configuration.items() if kind in KINDS and value is not None}
        key = resolver.node(settings.target, context, ())
        leaf = Leaf(key, digest(flat_parameters(plan.nodes, key)), shown)
        for figure in settings.figures:
            leaf.figures.append(resolver.node("figure", merge(context, {"figure": figure}), ()))
        plan.requested += sum(resolver.visits[one] for one in (key, *leaf.figures))
        first = seen.setdefault(key, leaf)
        first.ask_again(len(seen), shown)
        first.figures += [figure for figure in leaf.figures if figure not in first.figures]
    if plan is None:
        raise UserError("nothing to plan: the sweep is empty")
    plan.leaves += seen.values()
    return plan


def _check_target(kind: str) -> None:
    if kind in KINDS and not KINDS[kind].stored:
        stored = ", ".join(name for name, other in KINDS.items() if other.stored)
        raise UserError(f"target {kind!r} is not stored; end in a kind that is: {stored}")


@dataclass
class Resolver:
    """Finds the stages of leaves that have their datasets in common.

    What was found is remembered by the configurations of those kinds that were looked at on the way: leaves of a sweep differ
    in few of them.
    """

    plan: Plan
    datasets: Mapping[str, Any]
    looked_at: set[str] = field(default_factory=set)
    known: dict[str, dict[tuple[str, ...], dict[str, str]]] = field(default_factory=dict)
    visits: dict[str, int] = field(default_factory=dict)

    def node(self, kind: str, context: Context, path: tuple[tuple[str, Context], ...]) -> str:
        """Resolve the stage of one kind in a context, its inputs first; return its key."""
        # the end of a chain differs from leaf to leaf: it is not remembered
        for kinds, found in self.known.setdefault(kind, {}).items() if path else ():
            if key := found.get(json.dumps([context.get(one) for one in kinds]), ""):
                break
        else:
            outside, self.looked_at = self.looked_at, {kind}
            key, kinds = self._resolve(kind, context, path), tuple(sorted(self.looked_at))
            self.looked_at = outside
            if path:
                self.known[kind].setdefault(kinds, {})[json.dumps([context.get(one) for one in kinds])] = key
        self.looked_at.update(kinds)
        return key

    def _resolve(self, kind: str, context: Context, path: tuple[tuple[str, Context], ...]) -> str:
        if context.get(kind) is None:
            wanted = f", wanted by {path[-1][0]}" if path else ""
            names = ", ".join(sorted(names_of(kind))) or "none registered"
            raise UserError(f"no {kind} is configured{wanted}; choose {kind}= one of: {names}")
        configured = stage(context[kind])
        if not configured.get("name"):
            raise UserError(f"{kind}: the plugin's name is missing; set {kind}=NAME")
        method = plugin(kind, str(configured.pop("name")))
        overrides = configured.pop("inputs", None) or {}
        here = f"{kind}/{method.name}", context
        if here in path:
            raise UserError(f"cycle: {' -> '.join(name for name, _ in (*path[path.index(here) :], here))}")
        options = checked_options(method, configured)
        check_known(f"input of {kind}/{method.name}", overrides, method.inputs)
        inputs = {
            role: self._input(method, role, context, dict(overrides.get(role) or {}), (*path, here))
            for role in method.inputs
        }
        return self.add(method, options, inputs)

    def _input(
        self, method: Plugin, role: str, context: Context, override: Context, path: tuple[tuple[str, Context], ...]
    ) -> Any:
        wanted = method.inputs[role]
        dataset = override.pop("dataset", None)
        check_known(f"stage kind below inputs.{role} of {method.kind}/{method.name}", override, KINDS)
        context = merge(context, override)
        if wanted.shape == "one":
            key, where = self.node(wanted.kind, context, path), f"{method.kind}/{method.name}"
            name = self.plan.nodes[key].plugin
            allowed = method.accepts.get(wanted.kind, (name,))
            if name not in allowed:
                raise UserError(f"{where} takes no {wanted.kind} {name!r}; it takes: {', '.join(allowed)}")
            return key
        check_known(f"dataset of list input {role!r} of {method.kind}/{method.name}", [str(dataset)], self.datasets)
        members = members_of(self.datasets[str(dataset)])
        check_known(f"key of an item of dataset {dataset!r}", sorted(set().union(*members.values())), (*KINDS, *FACTS))
        keys = {member: self.node(wanted.kind, merge(context, part), path) for member, part in members.items()}
        named = {member.label: key for member, key in keys.items()}
        return {"members": keys, "dict": named, "list": list(keys.values())}[wanted.shape]

    def add(self, method: Plugin, options: dict[str, Any], wired: dict[str, Any]) -> str:
        """Add a stage to the plan by its checked options and the keys of its inputs; return its own key."""
        function, where = method.function.__qualname__, str(method.file)
        code, cache = code_digest(method.file, function), compiled_state(method.file)
        named = [name for name in sorted(method.paths) if options.get(name) is not None]
        files = {name: _digest_of(Path(path)) for name, path in option_files(options, named).items()}
        rest = {name: value for name, value in options.items() if name not in named}
        asked = {role: keys for role, keys in wired.items() if method.inputs[role].shape == "members"}
        members = {role: [asdict(member) for member in keys] for role, keys in asked.items()}
        inputs = wired | {role: {member.label: key for member, key in keys.items()} for role, keys in asked.items()}
        key = digest([method.kind, method.name, {**rest, **files}, inputs, members, code])
        node = Node(key, method.kind, method.name, where, code, cache, options, inputs, files, members, function)
        self.plan.nodes[key] = node
        self.visits[key] = KINDS[method.kind].stored + sum(self.visits[child] for child in node.children)
        return key


def checked_options(method: Plugin, configured: Context) -> dict[str, Any]:
    """Return all options of a plugin, defaults included; UserError where one is unknown or outside its bounds."""
    where = f"{method.kind}/{method.name}"
    check_known(f"option of {where}", configured, method.options.model_fields)
    given = {name: value for name, value in configured.items() if value != "???"}
    try:
        return method.options(**given).model_dump(mode="json")
    except ValidationError as error:
        raise UserError(one_line(where, error)) from None


def _digest_of(path: Path) -> str:
    if not path.exists():
        raise UserError(f"file {str(path)!r} does not exist")
    return file_digest(path.resolve())
