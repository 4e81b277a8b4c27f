"""Many plugins at once: all there are, to be described."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from surfexp.lab.errors import UserError
from surfexp.lab.registry.folders import entry_points_of_plugins, plugin_files
from surfexp.lab.registry.registry import BROKEN, load_file


def loaders(working_folder: Path) -> dict[str, Callable[[], Any]]:
    """What loads each plugin file: the package's own, installed ones (`surfexp.plugins`), those in `plugins/` here."""
    files = {str(file): partial(load_file, file) for file in plugin_files(working_folder)}
    return {**files, **{point.value: partial(load_module, point.module) for point in entry_points_of_plugins()}}


def load_module(name: str) -> None:
    """Load one plugin module of an installed package."""
    specification = importlib.util.find_spec(name)
    if specification is None or not specification.origin:
        raise UserError(f"plugin module {name} does not exist, though an installed package names it")
    load_file(Path(specification.origin))


def load_all(working_folder: Path) -> None:
    """Load every plugin; what fails is remembered and the rest works, but two plugins of one name are refused."""
    for file, load in loaders(working_folder).items():
        guarded(file, load)


def guarded(file: str, load: Callable[[], Any]) -> None:
    """Load one plugin file, or remember in `BROKEN` why it fails; UserError where it defines a plugin that there is already."""
    try:
        load()
    except (Exception, SystemExit) as error:
        if "defined twice" in str(error):
            raise
        BROKEN[Path(file)] = str(error) if isinstance(error, UserError) else f"{file}: {error}"
