"""`surfexp doctor`: what is installed, what is missing and what to install."""

from __future__ import annotations

import importlib
import os
import platform
import re
import shutil
from importlib.metadata import PackageNotFoundError, requires, version
from importlib.util import find_spec
from pathlib import Path

import click

from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.extras import EXTRAS

SYSTEM = {"open3d": " and the system package libusb-1.0-0"}


@click.command(**shown("doctor", "", "--results other/results", cls=click.Command))
@results_option
def doctor(results: Path) -> int:
    """Show versions, extras and free disk, and what to install.

    The exit code is 1 if something needed is missing.
    """
    echo(f"python {platform.python_version()} on {platform.system()} {platform.machine()}, {os.cpu_count()} processors")
    missing = 0
    for package in sorted(core_packages()):
        try:
            echo(f"  ok       {package} {version(package)}")
        except PackageNotFoundError:
            missing += 1
            echo(f"  MISSING  {package}: pip install {package}")
    for extra in dict.fromkeys(extra for _, extra in EXTRAS.values()):
        absent = [package for module, (package, of) in EXTRAS.items() if of == extra and not _imports(module)]
        remedy = f"pip install 'surfexp[{extra}]'{SYSTEM.get(extra, '')}"
        echo(f"  absent   {extra}: {', '.join(absent)}; {remedy}" if absent else f"  ok       {extra} (extra)")
    folder = results if results.exists() else Path.cwd()
    free = shutil.disk_usage(folder).free / 1e9
    echo(f"  {'ok      ' if free > 1.0 else 'LOW     '} {free:.1f} GB free for {results}")
    writable = os.access(folder, os.W_OK)
    echo(
        f"  {'ok      ' if writable else 'READ-ONLY'} {folder.resolve()} {'' if writable else ': choose results=FOLDER'}"
    )
    return 1 if missing or not writable else 0


def core_packages() -> set[str]:
    """Names of the packages that `pip install surfexp` brings, from the metadata of the installed package."""
    return {re.split(r"[^\w.-]", line)[0] for line in requires("surfexp") or () if "extra ==" not in line}


def _imports(module: str) -> bool:
    """Whether a module is there; open3d is imported, since it lacks libraries of the system on many machines."""
    if module != "open3d":
        return find_spec(module) is not None
    try:
        importlib.import_module(module)
    except ImportError:
        return False
    return True
