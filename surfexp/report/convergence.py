"""Which rows of a run are not what was asked for: stopped before their tolerance, or with a gap over its bound."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from surfexp.contract.metric import Metric
from surfexp.lab.plan.outcome import outcome
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.registry.catalogue import catalogue
from surfexp.lab.store.kinds import KINDS
from surfexp.records.comparison import Comparison, comparisons
from surfexp.records.table import rows_of
from surfexp.report.declared import declared

UNCONVERGED = 3
# a relative gap of 1: the energy may be as far above the least one as the model's own scale
LARGEST_GAP = 1.0


def unconverged(plan: Plan, results: Path, groups: Sequence[Comparison] | None = None) -> list[str]:
    """Return one line for each row, and for each stage below one, that did not converge or whose gap is over its bound.

    The bound of a metric is the option that its declaration names, as the stage was configured; it counts where a result does
    not say itself whether it converged, as a published scheme does whose pair of operators has no gap of its own. The bound of
    every relative gap is 1 besides. A stage that failed is not among them. `groups` are the rows where they have been read.
    """
    lines = []
    leaves = {leaf.key for leaf in plan.leaves}
    for group in comparisons(rows_of(plan, results)) if groups is None else groups:
        for row in group.rows:
            node = plan.nodes[row.leaf.key]
            if why := reason(row.metrics, node.options, _meanings(plan, node, row.metrics)):
                shown = ", ".join(str(row.parameters.get(name, "–")) for name in group.varying)
                lines.append(f"{group.title}: {shown}: {why}")
    below = [node for node in plan.stored if node.key not in leaves]
    certified = {kind for kind in {node.kind for node in below} if _certified(kind)}
    for node in below:
        if node.kind in certified:
            metrics = outcome(results, node).metrics
            if why := reason(metrics, node.options, _meanings(plan, node, metrics)):
                lines.append(f"{node.kind}/{node.plugin} {node.key}: {why}")
    return lines


def _certified(kind: str) -> bool:
    """Whether results of a kind say that they converged; its class is not imported where the catalogue knows."""
    known = catalogue(Path.cwd())
    return kind in known.certified if kind in known.kinds else "converged" in getattr(KINDS[kind].result, "METRICS", {})


def _meanings(plan: Plan, node: Node, metrics: Mapping[str, float]) -> Mapping[str, Metric]:
    """What metrics mean, where a bound among the options counts; plugins are not imported for results that say it themselves."""
    return {} if not metrics or "converged" in metrics else declared(plan.nodes, node.key)


def reason(metrics: Mapping[str, float], options: Mapping[str, Any], meanings: Mapping[str, Metric]) -> str:
    """Why a result with these metrics is not what was asked for; "" where it is."""
    if metrics.get("converged") == 0.0:
        return "did not converge"
    gap = metrics.get("relative_gap", 0.0)
    if not gap <= LARGEST_GAP:
        return f"its relative gap is {gap:.3g}, over {LARGEST_GAP:g}"
    for name, metric in meanings.items() if "converged" not in metrics else ():
        bound = options.get(metric.bound) if metric.bound else None
        value = metrics.get(name)
        if bound is not None and value is not None and (math.isnan(value) or value > bound):
            return f"its {name.replace('_', ' ')} is {value:.3g}, over its {metric.bound.replace('_', ' ')} {bound:g}"
    return ""
