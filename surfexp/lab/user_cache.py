"""The user's cache folder, and small memories in it: what takes long to find out and follows from files alone."""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import tempfile
from pathlib import Path
from typing import Any

import platformdirs

from surfexp.io.replacing import replacing

ENTRIES_KEPT = 5000


def user_cache(part: str) -> Path:
    """Folder of one part of the user's cache."""
    return Path(platformdirs.user_cache_dir("surfexp")) / part


def fault(folder: Path) -> str:
    """Why nothing can be kept in a folder, which is made if it can be; "" if it can and nobody else can write it."""
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


class Memory:
    """Values of JSON by key, in one file of the user's cache, written at the end of the process where there are new ones.

    A file that is missing, damaged or not the user's is an empty memory. The latest entries are kept, up to a number.
    """

    def __init__(self, name: str, entries_kept: int = ENTRIES_KEPT) -> None:
        self.name, self.entries_kept = name, entries_kept
        self.entries: dict[str, Any] | None = None
        self.used: dict[str, Any] = {}
        self.owner = os.getpid()

    def get(self, key: str) -> Any:
        """The value of a key, None where it is not known."""
        if self.entries is None:
            self.entries = self._read()
        value = self.used.get(key, self.entries.get(key))
        if value is not None:
            self.used[key] = value
        return value

    def put(self, key: str, value: Any) -> None:
        """Keep a value."""
        if not self.used.keys() - (self.entries or {}).keys():
            atexit.register(self.save)
        self.used[key] = value

    def save(self) -> None:
        """Write the file, beside what other processes have written; a process that forked from this one writes nothing."""
        folder = user_cache("memory")
        if os.getpid() != self.owner or fault(folder):
            return
        others = {key: value for key, value in self._read().items() if key not in self.used}
        entries = dict(list({**others, **self.used}.items())[-self.entries_kept :])
        with contextlib.suppress(OSError, ValueError), replacing(folder / f"{self.name}.json") as temporary:
            temporary.write_text(json.dumps(entries))

    def _read(self) -> dict[str, Any]:
        with contextlib.suppress(OSError, ValueError, TypeError):
            file = user_cache("memory") / f"{self.name}.json"
            facts = file.stat()
            if facts.st_uid == os.getuid() and not facts.st_mode & 0o022 and not file.parent.stat().st_mode & 0o022:
                return dict(json.loads(file.read_text()))
        return {}
