"""Where the results of a plan come from: its command, and date, versions and machine of the last computation."""

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

from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store

KEYS = ("command", "date", "version", "python", "commit", "machine")


def note_origin(results: Path, plan: Plan, arguments: Sequence[str], computed: bool) -> None:
    """Note which command asks for a plan: `surfexp run` with these arguments; and where its results were just computed.

    Where nothing was computed, what is known of the plan stays.
    """
    file, command = _file(results, plan), shlex.join(["surfexp", "run", *arguments])
    if computed or not (file.exists() or read_origin(results, plan).get("command") == command):
        store.write_text(file, json.dumps({"command": command} | (_here() if computed else {}), indent=1))


def read_origin(results: Path, plan: Plan) -> dict[str, str]:
    """What `note_origin` noted, as text; empty where nothing was noted, as by plain Snakemake.

    Earlier versions kept one note for all plans of an experiment.
    """
    for file in (_file(results, plan), results / plan.settings.experiment / "origin.json"):
        with suppress(OSError, ValueError, TypeError, RecursionError):
            found = dict(json.loads(file.read_text()))
            return {key: str(found[key]).encode(errors="replace").decode() for key in KEYS if key in found}
    return {}


def forget_origin(results: Path, plan: Plan) -> None:
    """Remove what was noted: something was computed in another way since."""
    _file(results, plan).unlink(missing_ok=True)
    (results / plan.settings.experiment / "origin.json").unlink(missing_ok=True)


def _file(results: Path, plan: Plan) -> Path:
    return results / plan.settings.experiment / "origin" / f"{plan.identity}.json"


def _here() -> dict[str, str]:
    return {
        "date": datetime.now().isoformat(" ", "minutes"),
        "version": version("surfexp"),
        "python": platform.python_version(),
        "commit": commit(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors",
    }


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
