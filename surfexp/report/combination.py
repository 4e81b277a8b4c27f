"""Combinations of solver, model and operator that no run can compute, refused when they are planned."""

from __future__ import annotations

from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Node, Plan
from surfexp.variational.requirements import SOLVABLE_MODELS, check_combination

AS_PUBLISHED = {"split_bregman": "published_split_bregman", "chambolle_dual": "published_chambolle"}
AVERAGED = "vertex_averaged"
MODELS = frozenset().union(*SOLVABLE_MODELS.values())


def check_combinations(plan: Plan) -> None:
    """Refuse a solver of ours that does not solve its model, or not with its operator; others are not known here.

    Raises
    ------
    UserError
        Naming the solvers that do.
    """
    for node in plan.nodes.values():
        if node.kind == "solver":
            _check(plan, node)


def _check(plan: Plan, node: Node) -> None:
    inputs = {plan.nodes[child].kind: plan.nodes[child].plugin for child in node.children}
    published = node.options.get("scheme") == "as_published"
    solver = AS_PUBLISHED.get(node.plugin, node.plugin) if published else node.plugin
    model = inputs.get("model", "")
    if solver not in SOLVABLE_MODELS or model not in MODELS:
        return
    try:
        check_combination(solver, model, inputs.get("operator") != AVERAGED)
    except ValueError as error:
        said = str(error)
        for plain, name in AS_PUBLISHED.items():
            said = said.replace(name, f"{plain} with scheme=as_published")
        raise UserError(f"solver/{node.plugin}: {said}") from None
