"""Plans that were made before, by all that they follow from: the same request need not load a plugin to be planned again.

A plan follows from what was asked for, the configuration files, the items of tables and folders that stand for a
dataset, the code, and the files that options name. All but the last are the name under which it is kept in the user's
cache; the last are hashed again, and so is code that lies neither beside surfexp nor in a package that brings plugins.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.dataset_files import Item, is_of_files, items_of_files
from surfexp.lab.registry.catalogue import code_state
from surfexp.lab.registry.folders import configurations, shipped_plugin_folders, sources
from surfexp.lab.user_cache import fault, user_cache

if TYPE_CHECKING:
    from surfexp.lab.plan.plan import Plan

PLANS_KEPT = 30
PLAN = "plan.json"
# what else than its text decides what a configuration file means: resolvers that ask the environment or the clock, other folders
OPEN = re.compile(rb"\$\{[^}]*:|searchpath")

# one name, as it is or in quotes: no sweep, no list, no escape
PLAIN = re.compile(r"""(?P<name>[^'"\\$,()\[\]{}]+)|(['"])(?P<quoted>[^'"\\$]+)\2""")


def place(arguments: Sequence[str]) -> Path | None:
    """Where the plan of a request is kept in this state of code and configuration; None where the request does not say all."""
    folders = dict.fromkeys(folder.resolve() for folder in configurations())
    files = sorted(file for folder in folders for file in folder.rglob("*.yaml"))
    texts = [(str(file), file.read_bytes()) for file in files]
    asked = "\n".join(arguments).encode()
    if any(OPEN.search(text) for _, text in [("", asked), *texts]) or any(text.startswith("-") for text in arguments):
        return None
    if (own_data := _own_data(arguments)) is None:
        return None
    facts = [str(Path.cwd()), code_state(Path.cwd()), list(arguments), own_data, texts]
    return user_cache("plans") / hashlib.sha256(repr(facts).encode()).hexdigest()[:40]


def _own_data(arguments: Sequence[str]) -> list[list[Item]] | None:
    """The items of tables, folders and patterns that stand for a request's datasets; None where only Hydra can tell them."""
    found = []
    for text in arguments:
        key, _, value = text.lstrip("+").partition("=")
        if key.partition(".")[0] != "datasets":
            continue
        if (plain := PLAIN.fullmatch(value.strip())) is None:
            return None
        name = plain["name"] or plain["quoted"]
        try:
            found.append(items_of_files(Path(name)) if is_of_files(name) else [])
        except (OSError, UserError):  # planning says what is wrong
            return None
    return found


def remembered(folder: Path | None) -> Plan | None:
    """The plan that is kept at a place, None where it has to be made (again)."""
    from surfexp.lab.plan.kinds_of_plans import load_own_kinds
    from surfexp.lab.plan.plan import read_plan
    from surfexp.lab.registry.catalogue import open_catalogue

    if folder is None or fault(folder.parent) or not folder.is_dir():
        return None
    with contextlib.suppress(Exception):  # a cache that cannot be read is none
        kept = json.loads((folder / "kept.json").read_text())
        file = folder / PLAN
        if _sha256(file) != kept["digest"]:
            return None
        plan = read_plan(file)
        open_catalogue(Path.cwd())
        load_own_kinds(plan)
        if _unchanged(plan, kept):
            folder.touch()
            return plan
    return None


def remember(folder: Path | None, plan: Plan) -> None:
    """Keep a plan at a place that was found before it was made; nothing happens where the cache cannot be written."""
    if folder is None or fault(folder.parent):
        return
    with contextlib.suppress(OSError):
        others = sorted(folder.parent.iterdir(), key=lambda path: path.stat().st_mtime)
        for old in [folder, *others[: max(0, len(others) - PLANS_KEPT + 1)]]:
            shutil.rmtree(old, ignore_errors=True)
        folder.mkdir(mode=0o700)
        file = folder / PLAN
        file.write_text(plan.text())
        kept = {"digest": _sha256(file), **_read_by(plan)}
        (folder / "kept.json").write_text(json.dumps(kept))


def _sha256(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def _read_by(plan: Plan) -> dict[str, Any]:
    """Digests of what stages read, files that options name and the data of packages, and methods to be hashed again.

    These lie outside of surfexp, or reach sources of which `code_state` does not know.
    """
    from surfexp.lab.plan.code_digests import code_closure, data_digest
    from surfexp.lab.plan.source_facts import source_facts
    from surfexp.lab.registry.option_files import file_named

    nodes = plan.nodes.values()
    closures = {(Path(node.file), node.function): code_closure(Path(node.file), node.function)[0] for node in nodes}
    facts = [*map(source_facts, set().union(*closures.values())), *(source_facts(*method) for method in closures)]
    packages = {package for fact in facts for package in fact.data_packages}
    named = {file_named(node.options, name): planned for node in nodes for name, planned in node.files.items()}
    own, known = {*shipped_plugin_folders()}, {*sources(Path.cwd())}
    methods = [method for method, reached in closures.items() if not own & {*method[0].parents} or reached - known]
    return {
        "files": named,
        "packages": {package: data_digest(package) for package in packages},
        "methods": [(str(file), function) for file, function in methods],
    }


def _unchanged(plan: Plan, kept: Mapping[str, Any]) -> bool:
    """Whether files, the data of packages, and the code of methods that are to be hashed again are what they were."""
    from surfexp.lab.digests import file_digest
    from surfexp.lab.plan.code_digests import code_digest, data_digest

    codes = {(node.file, node.function): node.code for node in plan.nodes.values()}
    return (
        all(file_digest(Path(path).resolve()) == known for path, known in kept["files"].items())
        and all(data_digest(package) == known for package, known in kept["packages"].items())
        and all(code_digest(Path(file), function) == codes[file, function] for file, function in kept["methods"])
    )
