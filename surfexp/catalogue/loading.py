"""Many plugins at once: all there are, to be described, or those of a plan that was made elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from surfexp.catalogue.folders import entry_points_of_plugins, plugin_files
from surfexp.workflow.errors import UserError

if TYPE_CHECKING:
    from surfexp.workflow.plan import Plan

Tell = Callable[[str], None]
# how `registry.load_file` begins the names of modules
OF_FILE = "surfexp_plugin_"


def load_all(
    working_folder: Path, faults: Mapping[str, str] = MappingProxyType({}), tell: Tell = lambda file: None
) -> None:
    """Load every plugin: the package's own, installed packages' (entry-point group `surfexp.plugins`), `plugins/` here.

    A file that fails is remembered in `BROKEN` and the rest still works; two plugins of one name are refused. Files with known
    `faults` are not loaded; the name of each other one is told before it is.
    """
    from surfexp.workflow.registry import BROKEN, load_file

    files: list[tuple[Path, Callable[[], Any]]] = [
        (file, partial(load_file, file)) for file in plugin_files(working_folder)
    ]
    for file, load in [*files, *((Path(point.value), point.load) for point in entry_points_of_plugins())]:
        if str(file) in faults:
            BROKEN[file] = faults[str(file)]
            continue
        tell(str(file))
        _guarded(file, load)


def load_own_kinds(plan: Plan) -> None:
    """Load the plugin files of a plan that this working folder has made, if they declare a stage kind of their own."""
    from surfexp.workflow.kinds import KINDS
    from surfexp.workflow.registry import load_file

    classes = {node.kind: KINDS[node.kind].path if node.kind in KINDS else "" for node in plan.nodes.values()}
    # a class of a plugin file is there once the file is loaded: no import finds it
    if any(
        not path or (path.startswith(OF_FILE) and path.partition(":")[0] not in sys.modules)
        for path in classes.values()
    ):
        for file in {node.file for node in plan.nodes.values()}:
            load_file(Path(file))


def load_known_kinds(plan: Plan) -> None:
    """Load plugins of a plan that others may have made: those found here or installed, never the files that it names."""
    from surfexp.workflow import registry

    registry.open_catalogue(Path.cwd())
    for kind, name in {(node.kind, node.plugin) for node in plan.nodes.values()}:
        with suppress(UserError):
            registry.plugin(kind, name)


def _guarded(file: Path, load: Callable[[], Any]) -> None:
    from surfexp.workflow.registry import BROKEN

    try:
        load()
    except Exception as error:
        if "defined twice" in str(error):
            raise
        BROKEN[file] = str(error) if isinstance(error, UserError) else f"{file}: {error}"
