"""Which stages are exported: those of an experiment, or of one run of it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from surfexp.lab.errors import UserError, check_known, unknown
from surfexp.lab.plan.kinds_of_plans import load_known_kinds
from surfexp.lab.plan.plan import Node, Plan, latest_plan, plans_by_age, read_plan
from surfexp.lab.registry.folders import experiments
from surfexp.records.tracking import tracking_uri

ON_VERTICES = ("surface", "image", "feature")
KEY, RUN = re.compile(r"[0-9a-f]{8,20}"), re.compile(r"[0-9a-f]{32}")


def find(results: Path, target: str) -> tuple[Plan, str]:
    """Return the plan that a target is of, and the key of the result that it names, "" where it is the whole experiment.

    Parameters
    ----------
    results : Path
    target : str
        The name of an experiment, whose latest configuration is taken; the key of a result, as the column `leaf` of
        metrics.csv and the tag `leaf` of a run have it, or its first 8 digits or more; or the id of an MLflow run.

    Raises
    ------
    UserError
        If there is no such thing, or more than one.
    """
    plans = plans_by_age(results)[::-1]
    names = {file.stem.rpartition("-")[0] for file in plans}
    key = _leaf_of_run(results, target) if RUN.fullmatch(target) and target not in names else target
    if key in names:
        plan, key = latest_plan(results, key), ""
    elif found := _plan_of_key(plans, key):
        plan, key = found
    elif target in experiments():
        raise UserError(f"{target!r} has no results in {results}: surfexp run experiment={target}")
    else:
        raise unknown(f"experiment or run in {results}", target, names)
    load_known_kinds(plan)
    return plan, key


def _plan_of_key(plans: Iterable[Path], key: str) -> tuple[Plan, str] | None:
    """The latest plan that has a result of this key, whole or begun, and the whole key."""
    for file in plans:
        if KEY.fullmatch(key) and f'"{key}' in file.read_text():
            plan = read_plan(file)
            whole = [other for other in plan.nodes if other.startswith(key)]
            if len(whole) > 1:
                raise UserError(f"{key!r} begins the keys {', '.join(whole)}: write more of one")
            if whole:
                return plan, whole[0]
    return None


def _leaf_of_run(results: Path, run: str) -> str:
    """The key of the result that an MLflow run is of, or the experiment of a run that stands for all of one; "" if none."""
    if not (results / "mlflow.db").exists():
        return ""
    from mlflow.exceptions import MlflowException
    from mlflow.tracking import MlflowClient

    client = MlflowClient(tracking_uri(results))
    try:
        found = client.get_run(run)
    except MlflowException:
        return ""
    leaf = str(found.data.tags.get("leaf", ""))
    return client.get_experiment(found.info.experiment_id).name if leaf == "plan" else leaf


def chosen_stages(plan: Plan, key: str, everything: bool, kinds: Sequence[str]) -> list[Node]:
    """Return the stages that are exported, surfaces last, since they carry the maps of the others.

    Parameters
    ----------
    plan : Plan
    key : str
        Of one result, "" for those of all rows.
    everything : bool
        Every stored stage, of the rows or of the one result.
    kinds : sequence of str
        Only stages of these kinds, wherever they stand in the chain; none: the rows, their figures, and the surfaces, images
        and features below them.

    Raises
    ------
    UserError
        If no stage is of one of the kinds.
    """
    roots = [leaf for leaf in plan.leaves if key in ("", leaf.key)]
    keys = dict.fromkeys([key] if key else [leaf.key for leaf in roots])
    figures = dict.fromkeys(figure for leaf in roots for figure in leaf.figures)
    whole = dict.fromkeys(one for start in (*keys, *figures) for one in (*upstream(plan, start), start))
    stored = {node.key for node in plan.stored}
    there = {plan.nodes[one].kind for one in whole if one in stored}
    check_known(f"kind of results of {plan.settings.experiment!r}", kinds, there)
    companions = dict.fromkeys(one for start in keys for one in _opened_with(plan, start))
    taken = whole if everything or kinds else companions | keys | figures
    nodes = [plan.nodes[one] for one in taken if one in stored and (not kinds or plan.nodes[one].kind in kinds)]
    return sorted(nodes, key=lambda node: node.kind == "surface")


def upstream(plan: Plan, key: str) -> list[str]:
    """Return the keys of all that a stage is made from, each once, inputs before what is made from them."""
    found: dict[str, None] = {}

    def visit(one: str) -> None:
        for child in plan.nodes[one].children:
            if child not in found:
                visit(child)
                found[child] = None

    visit(key)
    return list(found)


def surfaces_of(plan: Plan, key: str) -> list[str]:
    """Return the keys of the surfaces that a stage was made on: the nearest ones, members of collections left out."""
    return [one for one in _opened_with(plan, key) if plan.nodes[one].kind == "surface"]


def _opened_with(plan: Plan, key: str) -> list[str]:
    """The surfaces, images and features on whose vertices a result lives, or stands beside."""
    found: dict[str, None] = {}
    for child in (value for value in plan.nodes[key].inputs.values() if isinstance(value, str)):
        if plan.nodes[child].kind in ON_VERTICES:
            found[child] = None
        if plan.nodes[child].kind != "surface":
            found.update(dict.fromkeys(_opened_with(plan, child)))
    return list(found)
