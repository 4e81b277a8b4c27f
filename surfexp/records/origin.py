"""Where the results of a page come from: command, date, versions and machine of the last computation."""

from __future__ import annotations

import json
import os
import platform
import shlex
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from datetime import datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from surfexp.lab.store import store

FILE = "origin.json"
KEYS = ("command", "date", "version", "python", "commit", "machine")


def write_origin(folder: Path, arguments: Sequence[str]) -> None:
    """Note beside a report how its results were just made: by `surfexp run` with these arguments."""
    origin = {
        "command": shlex.join(["surfexp", "run", *arguments]),
        "date": datetime.now().isoformat(" ", "minutes"),
        "version": version("surfexp"),
        "python": platform.python_version(),
        "commit": commit(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors",
    }
    store.write_text(folder / FILE, json.dumps(origin, indent=1))


def read_origin(folder: Path) -> dict[str, Any]:
    """What `write_origin` noted, as text; empty where nothing was noted, as by plain Snakemake."""
    with suppress(OSError, ValueError, TypeError, RecursionError):
        found = dict(json.loads((folder / FILE).read_text()))
        return {key: str(found[key]).encode(errors="replace").decode() for key in KEYS if key in found}
    return {}


def forget_origin(folder: Path) -> None:
    """Remove what was noted: something was computed in another way since."""
    (folder / FILE).unlink(missing_ok=True)


def commit() -> str:
    """The commit of the checkout that this package is used from; else its version, as "release 1.2.3"."""
    checkout = Path(__file__).resolve().parents[2]
    if (checkout / ".git").exists():
        with suppress(OSError):
            asked = subprocess.run(  # noqa: S603, a path and no shell
                ["git", "-C", str(checkout), "rev-parse", "HEAD"],  # noqa: S607, the user's own git
                capture_output=True,
                text=True,
                check=False,
            )
            if found := asked.stdout.strip():
                return found
    return f"release {version('surfexp')}"
