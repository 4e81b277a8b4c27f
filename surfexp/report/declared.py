"""What the metrics of a stage mean, and the check, before anything runs, that whatever names one names a declared one."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from typing import Any

from pydantic.fields import FieldInfo

from surfexp.contract.metric import NAMES_METRIC, Metric, find_metric
from surfexp.lab.errors import UserError, unknown
from surfexp.lab.experiment.claim import read_claims
from surfexp.lab.plan.kinds_of_plans import load_known_kinds
from surfexp.lab.plan.plan import Leaf, Node, Plan
from surfexp.lab.registry.registry import names_of, plugin
from surfexp.lab.store.kinds import KINDS
from surfexp.records.table import Row
from surfexp.report.verdict import equal, selected

SECONDS = {"seconds": Metric("processor seconds of the stage, without compilation", "s", "lower")}


def declared(nodes: Mapping[str, Node], key: str) -> dict[str, Metric]:
    """The metrics that a stage declares: those of its kind, its plugin, and of inputs whose metrics it hands on.

    Handed on are those of inputs of its own kind (a surface made from a surface), of inputs that live inside its job (the
    model of a solver), and of the inputs that its class names (the solver that was measured).
    """
    node = nodes[key]
    metrics = {**getattr(KINDS[node.kind].result, "METRICS", {}), **plugin(node.kind, node.plugin).metrics}
    handed_on = [node.inputs.get(role) for role in getattr(KINDS[node.kind].result, "HANDED_ON", ())]
    for child in node.children:
        kind = nodes[child].kind
        if kind == node.kind or child in handed_on or not KINDS[kind].stored:
            metrics |= declared(nodes, child)
    return metrics


def declared_by(plan: Plan, rows: Sequence[Row]) -> dict[str, Metric]:
    """The metrics that the rows of a table declare; those of plugins that are not found here are left out."""
    chains = {
        tuple((name, value) for name, value in row.parameters.items() if name.endswith(".name")): row.leaf.key
        for row in rows
    }
    load_known_kinds(plan)
    metrics = dict[str, Metric]()
    for key in chains.values():
        with suppress(UserError, KeyError, ImportError):
            metrics |= declared(plan.nodes, key)
    return metrics


def check_names(plan: Plan) -> None:
    """Refuse claims, columns, figures and objectives that name what no row has; UserError with the nearest name."""
    metrics = {leaf.key: {**declared(plan.nodes, leaf.key), **SECONDS} for leaf in plan.leaves}
    rows = [Row(leaf, plan.parameters(leaf), {}, 0.0) for leaf in plan.leaves if plan.settings.claims]
    for claim in read_claims(plan.settings.claims):
        where = f"claim ({claim.claim[:60]})"
        for wanted in claim.selections:
            _check_parameters(where, wanted, rows)
            for row in selected(wanted, rows):
                _check_metric(where, claim.metric, metrics[row.leaf.key])
    _check_columns(plan.leaves, metrics)
    for leaf in plan.leaves:
        if leaf.settings["objective"] is not None:
            _check_metric("objective", leaf.settings["objective"], metrics[leaf.key])
    for node in plan.nodes.values():
        _check_options(plan, node)


def leave_out_columns(plan: Plan, replaced: Collection[str]) -> list[str]:
    """Leave out the columns that only another plugin of the replaced kinds declares; return their names.

    A solver may take no model: those of kinds that live inside a job and that the plan has no more count too.

    Parameters
    ----------
    plan : Plan
        Its leaves' settings are changed.
    replaced : collection of str
        Kinds for which a request names another plugin than the experiment does.
    """
    metrics = [declared(plan.nodes, leaf.key) | SECONDS for leaf in plan.leaves]
    here = {name: metric for known in metrics for name, metric in known.items()}
    asked = dict.fromkeys(name for leaf in plan.leaves for settings in leaf.shown for name in settings["columns"])
    missing = [name for name in asked if find_metric(name, here) is None]
    present = {node.kind for node in plan.nodes.values()}
    gone = [name for name, kind in KINDS.items() if replaced and not kind.stored and name not in present]
    elsewhere = _of_kinds([*replaced, *gone]) if missing else {}
    left_out = [name for name in missing if find_metric(name, elsewhere) is not None]
    changed: dict[int, dict[str, Any]] = {}  # leaves share their settings

    def without(settings: dict[str, Any]) -> dict[str, Any]:
        kept = [name for name in settings["columns"] if name not in left_out]
        return changed.setdefault(id(settings), settings | {"columns": kept})

    for leaf in plan.leaves if left_out else ():
        leaf.settings, leaf.also = without(leaf.settings), [(place, without(settings)) for place, settings in leaf.also]
    return left_out


def _of_kinds(kinds: Collection[str]) -> dict[str, Metric]:
    """What any plugin of some kinds declares; a plugin that cannot be loaded is left out."""
    found: dict[str, Metric] = {}
    for kind in kinds:
        found |= getattr(KINDS[kind].result, "METRICS", {})
        for name in names_of(kind):
            with suppress(UserError, ImportError):
                found |= plugin(kind, name).metrics
    return found


def _check_metric(where: str, name: str, metrics: Mapping[str, Metric]) -> None:
    if find_metric(name, metrics) is None:
        raise unknown(f"metric in {where}", name, metrics)


def _check_parameters(where: str, wanted: Mapping[str, Any], rows: Sequence[Row]) -> None:
    for name, value in wanted.items():
        values = [row.parameters[name] for row in rows if row.parameters.get(name) is not None]
        if not values:
            raise unknown(f"parameter in {where}", name, {known for row in rows for known in row.parameters})
        whole = not isinstance(value, list) or any(equal(value, other) for other in values)
        for one in [value] if whole else value:
            # another plugin of the name may be what the claim waits for, as data that has to be fetched first
            elsewhere = name.endswith(".name") and any(one in names_of(kind) for kind in KINDS)
            if not elsewhere and not any(equal(one, other) for other in values):
                raise unknown(f"value of {name} in {where}", str(one), {str(other) for other in values})


def _check_columns(leaves: Sequence[Leaf], metrics: Mapping[str, Mapping[str, Metric]]) -> None:
    """Tables may share their columns: each is one that some row of the experiment declares."""
    anywhere = {name: metric for known in metrics.values() for name, metric in known.items()}
    for name in dict.fromkeys(name for leaf in leaves for settings in leaf.shown for name in settings["columns"]):
        _check_metric("columns", name, anywhere)


def _check_options(plan: Plan, node: Node) -> None:
    """Options that name metrics name those of an input."""
    metrics = {name: metric for child in node.children for name, metric in declared(plan.nodes, child).items()}
    for option, field in plugin(node.kind, node.plugin).options.model_fields.items():
        value = node.options[option]
        if value is not None and names_metric(field):
            for name in [value] if isinstance(value, str) else value.values() if isinstance(value, dict) else value:
                _check_metric(f"{node.kind}/{node.plugin}.{option}", name, metrics | SECONDS)


def names_metric(field: FieldInfo) -> bool:
    """Whether an option is declared as the name of a metric, or as several."""
    return NAMES_METRIC in field.metadata or NAMES_METRIC in str(field.annotation)
