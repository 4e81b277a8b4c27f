"""What no run can compute or draw, known when it is planned: such solvers are refused, such figures left out."""

from __future__ import annotations

from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Node, Plan
from surfexp.variational.requirements import SOLVABLE_MODELS, check_combination

AS_PUBLISHED = {"split_bregman": "published_split_bregman", "chambolle_dual": "published_chambolle"}
AVERAGED = "vertex_averaged"
MODELS = frozenset().union(*SOLVABLE_MODELS.values())
WITH_REGIONS = frozenset({"convex_chan_vese", "multiphase", "chan_vese"})
DRAW_REGIONS = frozenset({"parcellation", "segmentation", "regions"})


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


def leave_out_figures(plan: Plan) -> list[str]:
    """Leave out figures of regions where the model is one of ours that has none; return a line for each pair of them.

    Parameters
    ----------
    plan : Plan
        Its leaves, and the stages that nothing needs any more, are changed.
    """
    said = dict.fromkeys(
        f"figure/{plan.nodes[figure].plugin} is left out: {model} has no regions to draw"
        for leaf in plan.leaves
        for figure in leaf.figures
        if (model := _without_regions(plan, figure))
    )
    for leaf in plan.leaves if said else ():
        leaf.figures = [figure for figure in leaf.figures if not _without_regions(plan, figure)]
    if said:
        needed = {key for leaf in plan.leaves for end in (leaf.key, *leaf.figures) for key in _reached(plan, end)}
        plan.nodes = {key: node for key, node in plan.nodes.items() if key in needed}
    return list(said)


def _without_regions(plan: Plan, figure: str) -> str:
    """The model of the solution that a figure of regions draws, where it has none; else empty."""
    node = plan.nodes[figure]
    solver = node.inputs.get("solver")
    if node.plugin not in DRAW_REGIONS or not isinstance(solver, str):
        return ""
    models = {plan.nodes[child].plugin for child in plan.nodes[solver].children if plan.nodes[child].kind == "model"}
    return next(iter(models & (MODELS - WITH_REGIONS)), "")


def _reached(plan: Plan, key: str) -> set[str]:
    found, waiting = set[str](), [key]
    while waiting:
        if (one := waiting.pop()) not in found:
            found.add(one)
            waiting += plan.nodes[one].children
    return found
