"""Where numba keeps compiled code: in the user's cache folder, one folder for each state of the code.

Numba's index is a pickle, which runs code when it is read. So a folder is used only if it belongs to the user and nobody
else can write it; the results folder takes its place then, and a temporary folder where that is foreign as well.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path

import platformdirs

STATES_KEPT = 8
_temporary: list[tempfile.TemporaryDirectory[str]] = []


def use(results: Path, state: str) -> str:
    """Let numba keep the code of one state, here and in processes to come; say why not in the user's cache folder.

    To be called before numba is imported, which reads its settings once.
    """
    folder, reason = choose(results, state)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    os.environ["NUMBA_CACHE_LOCATOR_CLASSES"] = "surfexp.workers.numba_cache.CheckedFolder"
    return reason


@cache
def choose(results: Path, state: str) -> tuple[Path, str]:
    """The folder of a state of the code, and in one line why it is not in the user's cache folder ("" when it is)."""
    faults: list[str] = []
    for parent in (Path(platformdirs.user_cache_dir("surfexp")) / "compiled", results / "cache" / "numba"):
        if fault := _fault(parent):
            faults.append(fault)
            continue
        folder = parent / state
        if not folder.exists():
            _forget_oldest(parent)
            folder.mkdir(mode=0o700, exist_ok=True)
        return folder, f"compiled code is kept in {parent}: {faults[0]}" if faults else ""
    _temporary.append(tempfile.TemporaryDirectory(prefix="surfexp-"))
    return Path(_temporary[-1].name), f"compiled code is not kept: {'; '.join(faults)}"


def _fault(folder: Path) -> str:
    """Why compiled code cannot be kept below a folder, which is made if it can be; "" if it can."""
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=0o700, exist_ok=True)
        facts = folder.stat()
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        return f"{folder} cannot be written ({error.strerror})"
    if facts.st_uid != os.getuid():
        return f"{folder} belongs to another user ({facts.st_uid})"
    return f"{folder} can be written by others (mode {facts.st_mode & 0o777:o})" if facts.st_mode & 0o022 else ""


def _forget_oldest(folder: Path) -> None:
    """Make room for a new state: the code of the latest ones stays."""
    states = sorted((path for path in folder.iterdir() if path.is_dir()), key=lambda path: path.stat().st_mtime)
    for path in states[: max(0, len(states) - STATES_KEPT + 1)]:
        with contextlib.suppress(OSError):
            shutil.rmtree(path)


def complaints() -> list[str]:
    """What was wrong with files of compiled code in this process, a line each."""
    numba_cache = sys.modules.get("surfexp.workers.numba_cache")
    return list(numba_cache.complaints) if numba_cache else []
