"""The code that a stage runs: read before it is imported, so that it can be compared with what was planned."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from surfexp.lab.plan.code_digests import code_digest
from surfexp.lab.plan.plan import Node
from surfexp.lab.registry import registry
from surfexp.lab.store.kinds import KINDS


def read_code(nodes: Mapping[str, Node], key: str) -> None:
    """Read what a stage and its inputs are made by; what is read first is what `check_code` compares."""
    for one in (key, *nodes[key].children):
        code_digest(Path(nodes[one].file), nodes[one].function)


def loaded_methods(nodes: Mapping[str, Node], key: str) -> set[tuple[Path, str, str]]:
    """Load the code of a stage, and of the unstored stages that it makes itself; return file, function and planned digest of each.

    A file may declare the kinds of its inputs, so it is loaded before they are looked at.
    """
    node = nodes[key]
    registry.load_file(Path(node.file))
    found = {(Path(node.file), node.function, node.code)}
    for child in node.children:
        registry.load_file(Path(nodes[child].file))
        if not KINDS[nodes[child].kind].stored:
            found |= loaded_methods(nodes, child)
    return found
