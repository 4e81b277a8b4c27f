"""Files that plugins import from elsewhere, a folder of `PYTHONPATH` or an editable package, and that change in place."""

from __future__ import annotations

import sys
import sysconfig
from collections.abc import Collection
from pathlib import Path

from surfexp.lab.registry.installed import installed_folders


def imported_from_elsewhere(known: Collection[Path]) -> dict[str, list[int]]:
    """Facts about every file that this process has imported and that is neither known nor of an installed distribution.

    Parameters
    ----------
    known : collection of Path
        Files that are watched in another way.

    Returns
    -------
    dict of str to list of int
        Size and time of the last change.
    """
    places = [*installed_folders(), *(Path(sysconfig.get_path(name)) for name in ("stdlib", "platstdlib"))]
    places = [place.resolve() for place in places]
    named = {getattr(module, "__file__", None) for module in list(sys.modules.values())}
    files = {Path(name).resolve() for name in named if isinstance(name, str)}
    found = (file for file in files - {*known} if not any(file.is_relative_to(place) for place in places))
    return {str(file): facts for file in sorted(found) if (facts := file_facts(file))}


def file_facts(file: Path) -> list[int]:
    """Size and time of the last change; empty where there is no such file."""
    try:
        state = file.stat()
    except OSError:
        return []
    return [state.st_size, state.st_mtime_ns]
