"""Many plugins at once: all there are, to be described, or those of a plan that was made elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.lab.errors import UserError
from surfexp.lab.registry.folders import entry_points_of_plugins, plugin_files

if TYPE_CHECKING:
    from surfexp.lab.plan.plan import Plan

# how `registry.load_file` begins the names of modules
OF_FILE = "surfexp_plugin_"


def loaders(working_folder: Path) -> dict[str, Callable[[], Any]]:
    """What loads each plugin file: the package's own, installed ones (`surfexp.plugins`), those in `plugins/` here."""
    from surfexp.lab.registry.registry import load_file

    files = {str(file): partial(load_file, file) for file in plugin_files(working_folder)}
    return {**files, **{point.value: point.load for point in entry_points_of_plugins()}}


def load_all(working_folder: Path) -> None:
    """Load every plugin; a file that fails is remembered and the rest works, two plugins of one name are refused."""
    for file, load in loaders(working_folder).items():
        guarded(file, load)


def load_own_kinds(plan: Plan) -> None:
    """Load the plugin files of a plan that this working folder has made, if they declare a stage kind of their own."""
    from surfexp.lab.registry.registry import load_file
    from surfexp.lab.store.kinds import KINDS

    classes = {node.kind: KINDS[node.kind].path if node.kind in KINDS else "" for node in plan.nodes.values()}
    # a class of a plugin file is there once the file is loaded: no import finds it
    if any(
        not path or (path.startswith(OF_FILE) and path.partition(":")[0] not in sys.modules)
        for path in classes.values()
    ):
        for file in {node.file for node in plan.nodes.values()}:
            load_file(Path(file))


def load_known_kinds(plan: Plan) -> None:
    """Load plugins of a plan that others may have made: those found here or installed, never files that it names."""
    from surfexp.lab.registry import registry

    registry.open_catalogue(Path.cwd())
    for kind, name in {(node.kind, node.plugin) for node in plan.nodes.values()}:
        with suppress(UserError):
            registry.plugin(kind, name)


def guarded(file: str, load: Callable[[], Any]) -> None:
    """Load one plugin file, or remember in `BROKEN` why it fails."""
    from surfexp.lab.registry.registry import BROKEN

    try:
        load()
    except Exception as error:
        if "defined twice" in str(error):
            raise
        BROKEN[Path(file)] = str(error) if isinstance(error, UserError) else f"{file}: {error}"
