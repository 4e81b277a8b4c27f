"""What tells the stages of a run apart in a line: the options, of their own and before them, that differ."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from surfexp.lab.plan.plan import Node, flat_parameters

# beyond so many stages the differences of all are no longer looked for
MOST_STAGES = 3000
LONGEST = 60


def stage_words(nodes: Mapping[str, Node], shown: Sequence[Node]) -> dict[str, str]:
    """Return for the key of each stage that is shown what distinguishes it from others of its plugin; mostly few words.

    Parameters
    ----------
    nodes : dict of str to Node
        All stages of the plan.
    shown : sequence of Node
        Those of this run.

    Returns
    -------
    dict of str to str
        As "fem, noise 20"; empty for a stage that has no like.
    """
    if len(shown) > MOST_STAGES:
        return {}
    alike: dict[tuple[str, str], list[str]] = defaultdict(list)
    for node in shown:
        alike[node.kind, node.plugin].append(node.key)
    words = {}
    for keys in alike.values():
        facts = {key: flat_parameters(nodes, key) if len(keys) > 1 else {} for key in keys}
        differing = _differing(list(facts.values()))
        for key in keys:
            words[key] = _joined([(name, facts[key][name]) for name in differing if name in facts[key]])
    return words


def _differing(facts: list[dict[str, Any]]) -> list[str]:
    """Names of the facts that tell stages apart; plugins first, and none that divides them as another one does."""
    names = dict.fromkeys(name for one in facts for name in one)
    shown = sorted((name for name in names if _differs(name, facts)), key=lambda name: not name.endswith(".name"))
    first: dict[tuple[int, ...], str] = {}
    for name in shown:
        values = [json.dumps(one.get(name), default=str) for one in facts]
        first.setdefault(tuple(map(values.index, values)), name)
    return list(first.values())


def _differs(name: str, facts: list[dict[str, Any]]) -> bool:
    """Whether plugins differ, or an option between stages with one plugin."""
    prefix, _, option = name.rpartition(".")
    values: dict[str, set[str]] = defaultdict(set)
    for one in facts:
        plugin = "" if option == "name" else str(one.get(f"{prefix}.name"))
        values[plugin].add(json.dumps(one.get(name), default=str))
    return any(len(found) > 1 for found in values.values())


def _joined(facts: list[tuple[str, Any]]) -> str:
    said = ", ".join(_word(name, value) for name, value in facts)
    return said if len(said) <= LONGEST else f"{said[: LONGEST - 4]} ..."


def _word(name: str, value: Any) -> str:
    """A plugin by its name, an option by its own and its value."""
    option = name.rpartition(".")[2]
    if isinstance(value, float):
        value = f"{value:.4g}"
    return str(value) if option == "name" else f"{option.replace('_', ' ')} {value}"
