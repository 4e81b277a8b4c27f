"""A bundle run again in a folder of its own, its results held against those that came with it."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from surfexp.commands.bundling.agreement import Agreement, agreement, content_digest
from surfexp.commands.bundling.contents import PUBLISHED
from surfexp.commands.bundling.opening import CODE, FACTS, PLAN, opened, unpack
from surfexp.commands.execution import run
from surfexp.commands.verdict_lines import verdicts_of
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Plan, read_plan
from surfexp.lab.plan.replanning import replanned
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.registry.installed import package_version
from surfexp.lab.registry.option_files import file_named
from surfexp.lab.store import store
from surfexp.records.table import rows_of

RESULTS = Path("results")


def run_again(bundle: Path, folder: Path, trusted: Callable[[list[str]], bool]) -> dict[str, Any]:
    """Unpack a bundle, run it with the code that is installed, and compare; the working folder is that folder then.

    Parameters
    ----------
    bundle : Path
    folder : Path
        Empty, or made.
    trusted : function
        Asked with the names of the code in the bundle, before anything is written; False refuses it.

    Returns
    -------
    dict
        What rerun.json says: "rows", "verdicts", "versions", each as what agrees and what differs.

    Raises
    ------
    UserError
        If the bundle is refused.
    StageFailure
        If a stage failed.
    """
    names = opened(bundle)
    code = [name for name in names if name.startswith(CODE)]
    if code and not trusted(code):
        raise UserError(
            f"{bundle} brings code, which would run here ({', '.join(code[:3])}{', ...' if len(code) > 3 else ''}): "
            "read it, then say --trust"
        )
    unpack(bundle, names, folder)
    os.chdir(folder)
    facts = _facts(Path(FACTS))
    open_catalogue(Path.cwd())
    before = _read(Path(PLAN))
    _check_packages(before, facts["versions"])
    plan, keys = replanned(before)
    check_paths(plan, Path.cwd())
    run(plan)
    rows = {key: _agreement(before, key, keys[key]) for key in dict.fromkeys(leaf.key for leaf in before.leaves)}
    verdicts = [item.verdict for item in verdicts_of(plan, rows_of(plan, RESULTS.resolve()))]
    found = {
        "rows": [_row(before, key, keys[key], one) for key, one in rows.items()],
        "counts": dict(Counter(one.state for one in rows.values())),
        "verdicts": [[*pair, now] for pair, now in zip(facts["verdicts"], verdicts, strict=False)],
        "versions": {name: [of, now] for name, of in facts["versions"].items() if (now := package_version(name)) != of},
    }
    Path("rerun.json").write_text(json.dumps(found, indent=1), encoding="utf-8")
    return found


def _facts(path: Path) -> dict[str, Any]:
    try:
        facts = json.loads(path.read_text(encoding="utf-8"))
        return {
            "versions": dict(facts["versions"]),
            "verdicts": [(str(one), str(two)) for one, two in facts["verdicts"]],
        }
    except (KeyError, TypeError, ValueError, RecursionError):
        raise UserError(f"{path} of the bundle cannot be read: install the version that wrote it") from None


def _read(path: Path) -> Plan:
    try:
        return read_plan(path)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise UserError(f"{PLAN} of the bundle cannot be read ({error}): install the version that wrote it") from None


def _check_packages(plan: Plan, versions: Mapping[str, str]) -> None:
    """Say which package brings a plugin that is not known here, and is not installed."""
    from surfexp.lab.registry.registry import plugin

    for kind, name in sorted({(node.kind, node.plugin) for node in plan.nodes.values()}):
        try:
            plugin(kind, name)
        except UserError as error:
            absent = [f"{one}=={of}" for one, of in versions.items() if package_version(one) == "unknown"]
            way_out = f"; the bundle was made with {', '.join(absent)}, not installed here" if absent else ""
            raise UserError(f"{error}{way_out}") from None


def check_paths(plan: Plan, folder: Path) -> None:
    """Refuse a plan whose options name files outside of a folder; UserError with the first."""
    for node in plan.nodes.values():
        for option in node.files:
            path = file_named(node.options, option)
            if not (folder / path).resolve().is_relative_to(folder.resolve()):
                raise UserError(
                    f"{node.kind}/{node.plugin}: {option} is {path!r}, a file outside of the bundle: nothing was computed"
                )


def _agreement(plan: Plan, old: str, new: str) -> Agreement:
    kind = plan.nodes[old].kind
    places = ((Path(PUBLISHED), old), (RESULTS, new))
    records = [store.read_record(place, kind, key) for place, key in places]
    first, second = map(content_digest, records)
    if first == second:
        return Agreement("same")
    before, again = (store.load(place, kind, key) for place, key in places)
    return agreement(before, again, (first, second))


def _row(plan: Plan, old: str, new: str, found: Agreement) -> dict[str, str]:
    node = plan.nodes[old]
    return {
        "key": old,
        "key here": new,
        "stage": f"{node.kind}/{node.plugin}",
        "state": found.state,
        "reason": found.reason,
    }
