"""Where numba keeps compiled code: in the user's cache folder, one folder for each state of the code.

Numba's index is a pickle, which runs code when it is read. So a folder is used only if it belongs to the user and nobody
else can write it, and never one below results, which people send to one another: what is unpacked belongs to who unpacks
it. Where there is no such folder, one of the user's own among the temporary files takes its place.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path

from surfexp.lab.user_cache import fault, user_cache

STATES_KEPT = 50
_temporary: list[tempfile.TemporaryDirectory[str]] = []


def use(state: str) -> str:
    """Let numba keep the code of one state, here and in processes to come; say why not in the user's cache folder.

    To be called before numba is imported, which reads its settings once.
    """
    folder, reason = choose(state)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    os.environ["NUMBA_CACHE_LOCATOR_CLASSES"] = "surfexp.lab.running.numba_cache.CheckedFolder"
    return reason


@cache
def choose(state: str) -> tuple[Path, str]:
    """The folder of a state of the code, and in one line why it is not in the user's cache folder ("" when it is)."""
    faults: list[str] = []
    for parent in (user_cache("compiled"), Path(tempfile.gettempdir()) / f"surfexp-compiled-{os.getuid()}"):
        if reason := fault(parent):
            faults.append(reason)
            continue
        folder = parent / state
        if not folder.exists():
            _forget_oldest(parent)
            folder.mkdir(mode=0o700, exist_ok=True)
        os.utime(folder)  # the states that nobody uses any more are the first to go
        return folder, f"compiled code is kept in {parent}: {faults[0]}" if faults else ""
    _temporary.append(tempfile.TemporaryDirectory(prefix="surfexp-"))
    return Path(_temporary[-1].name), f"compiled code is not kept: {'; '.join(faults)}"


def _forget_oldest(folder: Path) -> None:
    """Make room for a new state: the code of those that were used last stays."""
    states = sorted((path for path in folder.iterdir() if path.is_dir()), key=lambda path: path.stat().st_mtime)
    for path in states[: max(0, len(states) - STATES_KEPT + 1)]:
        with contextlib.suppress(OSError):
            shutil.rmtree(path)


def complaints() -> list[str]:
    """What was wrong with files of compiled code in this process, a line each."""
    numba_cache = sys.modules.get("surfexp.lab.running.numba_cache")
    return list(numba_cache.complaints) if numba_cache else []
