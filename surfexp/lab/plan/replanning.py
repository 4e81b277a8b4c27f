"""A plan of another machine planned here: the same stages and options, with the code that is installed."""

from __future__ import annotations

from typing import Any

from surfexp.contract.member import Member
from surfexp.lab.digests import digest
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Keys, Leaf, Node, Plan, flat_parameters
from surfexp.lab.plan.resolution import Resolver, checked_options
from surfexp.lab.registry.registry import plugin


def replanned(plan: Plan) -> tuple[Plan, dict[str, str]]:
    """Plan all stages again by the plugins that are known here.

    Parameters
    ----------
    plan : Plan

    Returns
    -------
    Plan
        Its keys are those of the present code, and equal to the old ones where that is the same.
    dict of str to str
        The new key of each stage by its old one.

    Raises
    ------
    UserError
        If a plugin is not known here, or takes other inputs or options than it did.
    """
    here = Plan(plan.settings, requested=plan.requested)
    resolver, keys = Resolver(here, plan.settings.datasets), dict[str, str]()

    def visit(key: str) -> str:
        if key not in keys:
            node = plan.nodes[key]
            for child in node.children:
                visit(child)
            keys[key] = _again(node, resolver, keys)
        return keys[key]

    for leaf in plan.leaves:
        key = visit(leaf.key)
        figures = [visit(figure) for figure in leaf.figures]
        here.leaves.append(Leaf(key, digest(flat_parameters(here.nodes, key)), leaf.settings, figures, leaf.also))
    return here, keys


def _again(node: Node, resolver: Resolver, keys: dict[str, str]) -> str:
    method, where = plugin(node.kind, node.plugin), f"{node.kind}/{node.plugin}"
    if set(method.inputs) != set(node.inputs):
        taken, given = (", ".join(sorted(roles)) or "none" for roles in (method.inputs, node.inputs))
        raise UserError(
            f"{where} takes the inputs {taken} here, the plan gives {given}: install the version of the plan"
        )
    inputs = {role: _renamed(node, role, node.inputs[role], keys) for role in method.inputs}
    return resolver.add(method, checked_options(method, dict(node.options)), inputs)


def _renamed(node: Node, role: str, wired: Keys, keys: dict[str, str]) -> Any:
    """The keys of an input as they are now, by member where the plugin asks for what is known of members."""
    if isinstance(wired, str):
        return keys[wired]
    if not isinstance(wired, dict):
        return [keys[key] for key in wired]
    names = [Member(**facts) for facts in node.members[role]] if role in node.members else list(wired)
    return dict(zip(names, (keys[key] for key in wired.values()), strict=True))
