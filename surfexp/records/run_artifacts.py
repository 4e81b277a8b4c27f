"""What a run keeps as artifacts: its figures, and where its result and its inputs lie, with their hashes."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from surfexp.lab.errors import DamagedResult
from surfexp.lab.plan.plan import Leaf, Node, Plan
from surfexp.lab.store import store

POINTER = "result.json"


def keep_artifacts(folder: Path, plan: Plan, leaf: Leaf, results: Path, figures: Path, known: dict[str, Any]) -> None:
    """Put a row's figures and its pointer into the folder of its run's artifacts; nothing where they are there.

    Parameters
    ----------
    folder : Path
        Of the run's artifacts.
    plan : Plan
    leaf : Leaf
    results, figures : Path
        The results folder, and where the report keeps pictures, of which names end in eight digits of the key.
    known : dict
        The places of stages by their keys: those of earlier calls, to which others are added.
    """
    text = json.dumps(_pointer(plan, leaf, results, known), indent=1)
    file = folder / POINTER
    pictures = [found for key in leaf.figures for found in figures.glob(f"*-{key[:8]}.*")]
    if file.exists() and file.read_text(encoding="utf-8") == text and all(map(_is_kept(folder), pictures)):
        return
    shutil.rmtree(folder / "figures", ignore_errors=True)
    (folder / "figures" if pictures else folder).mkdir(parents=True, exist_ok=True)
    for picture in pictures:
        _link(picture, folder / "figures" / picture.name)
    store.write_text(file, text)


def _pointer(plan: Plan, leaf: Leaf, results: Path, known: dict[str, Any]) -> dict[str, Any]:
    """Say where the result of a row and all stages before it lie below the results folder, and their SHA-256."""
    before = _upstream(plan.nodes, leaf.key)
    for node in (*before, plan.nodes[leaf.key]):
        if node.key not in known:
            known[node.key] = _place(node, results)
    return {
        "experiment": plan.settings.experiment,
        "results": str(results),
        "export": f"surfexp export {leaf.key} --results {results}",
        "result": known[leaf.key],
        "inputs": [known[node.key] for node in before if known[node.key]],
    }


def _place(node: Node, results: Path) -> dict[str, Any]:
    """Kind, method, key, folder and hash of a stage; nothing of one that is not stored, or damaged, or not there."""
    try:
        record = store.read_record(results, node.kind, node.key)
    except (OSError, DamagedResult):
        return {}
    folder = store.result_folder(results, node.kind, node.key).relative_to(results)
    known = {"kind": node.kind, "method": node.plugin, "key": node.key, "folder": folder.as_posix()}
    return known | {"files": node.files, store.ARRAYS: record["arrays"]}


def _upstream(nodes: Mapping[str, Node], key: str) -> list[Node]:
    waiting, found = list(nodes[key].children), dict[str, Node]()
    while waiting:
        if (one := waiting.pop()) not in found:
            found[one] = nodes[one]
            waiting += nodes[one].children
    return list(found.values())


def _is_kept(folder: Path) -> Any:
    return lambda picture: (folder / "figures" / picture.name).exists()


def _link(source: Path, target: Path) -> None:
    """A second name of a file, which takes no room; a copy where there can be none."""
    target.unlink(missing_ok=True)
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)
