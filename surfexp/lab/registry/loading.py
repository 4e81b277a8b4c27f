"""Many plugins at once: all there are, to be described."""

from __future__ import annotations

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
    return {**files, **{point.value: point.load for point in entry_points_of_plugins()}}


def load_all(working_folder: Path) -> None:
    """Load every plugin; a file that fails is remembered and the rest works, two plugins of one name are refused."""
    for file, load in loaders(working_folder).items():
        guarded(file, load)


def guarded(file: str, load: Callable[[], Any]) -> None:
    """Load one plugin file, or remember in `BROKEN` why it fails."""
    try:
        load()
    except Exception as error:
        if "defined twice" in str(error):
            raise
        BROKEN[Path(file)] = str(error) if isinstance(error, UserError) else f"{file}: {error}"
