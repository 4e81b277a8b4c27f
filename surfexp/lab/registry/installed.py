"""Which distribution provides a top-level module, remembered as long as nothing is installed or removed."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

from surfexp.lab.user_cache import Memory

_memory = Memory("installed")


@cache
def package_version(module: str) -> str:
    """Version of the distribution that provides a top-level module, "unknown" when there is none."""
    for name in (module, *distributions(module)):
        try:
            return importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return "unknown"


@cache
def changes_in_place(module: str) -> bool:
    """Whether a top-level module may change under one version: it has none, or its distribution is installed editable."""
    if package_version(module) == "unknown":
        return True
    for name in (module, *distributions(module)):
        with suppress(importlib.metadata.PackageNotFoundError, ValueError):
            origin = importlib.metadata.distribution(name).read_text("direct_url.json")
            return bool(origin and json.loads(origin).get("dir_info", {}).get("editable"))
    return False


@cache
def distributions(module: str) -> tuple[str, ...]:
    """Names of the distributions that provide a module, empty when there is none."""
    key = f"{module} {installed_state()}"
    if (known := _memory.get(key)) is None:
        known = _every().get(module, [])
        _memory.put(key, known)
    return tuple(known)


@cache
def installed_state() -> str:
    """Digest of the folders with installed distributions and of when something was last added to or removed from them."""
    states = [(str(folder), folder.stat().st_mtime_ns) for folder in installed_folders()]
    return hashlib.sha256(repr(states).encode()).hexdigest()


def installed_folders() -> list[Path]:
    """Folders on the path with installed distributions."""
    return [Path(entry) for entry in sys.path if any(Path(entry).glob("*.dist-info"))]


_every = cache(importlib.metadata.packages_distributions)
