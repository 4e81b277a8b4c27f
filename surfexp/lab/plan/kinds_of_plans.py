"""The plugins of a plan loaded, as far as its results need them to be read."""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path

from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Plan
from surfexp.lab.registry import registry
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.store.kinds import KINDS

# how `registry.load_file` begins the names of modules
OF_FILE = "surfexp_plugin_"


def load_own_kinds(plan: Plan) -> None:
    """Load the plugin files of a plan that this working folder has made, if they declare a stage kind of their own."""
    classes = {node.kind: KINDS[node.kind].path if node.kind in KINDS else "" for node in plan.nodes.values()}
    # a class of a plugin file is there once the file is loaded: no import finds it
    if any(
        not path or (path.startswith(OF_FILE) and path.partition(":")[0] not in sys.modules)
        for path in classes.values()
    ):
        for file in {node.file for node in plan.nodes.values()}:
            registry.load_file(Path(file))


def load_known_kinds(plan: Plan) -> None:
    """Load plugins of a plan that others may have made: those found here or installed, never files that it names."""
    open_catalogue(Path.cwd())
    for kind, name in {(node.kind, node.plugin) for node in plan.nodes.values()}:
        with suppress(UserError):
            registry.plugin(kind, name)
