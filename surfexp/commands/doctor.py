"""`surfexp doctor`: what is installed, what is missing and how to mend it."""

from __future__ import annotations

import argparse
import importlib
import os
import platform
import shutil
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

NEEDED = (
    "numpy",
    "scipy",
    "numba",
    "libigl",
    "cholespy",
    "robust_laplacian",
    "hydra-core",
    "snakemake",
    "mlflow",
    "pydantic",
)
OPTIONAL = {
    "open3d": "more mesh formats, point clouds, the viewer: pip install 'surfexp[open3d]' and the system package libusb-1.0-0",
    "cvxpy": "the conic referee solver: pip install 'surfexp[conic]'",
}


def command(name: str, arguments: list[str]) -> int:
    """Print versions, optional parts and free disk; exit with 1 if something needed is missing."""
    parser = argparse.ArgumentParser(f"surfexp {name}", description=__doc__)
    parser.add_argument("--results", type=Path, default=Path("results"), help="results folder to examine")
    given = parser.parse_args(arguments)
    print(
        f"python {platform.python_version()} on {platform.system()} {platform.machine()}, {os.cpu_count()} processors"
    )
    missing = 0
    for package in NEEDED:
        try:
            print(f"  ok       {package} {version(package)}")
        except PackageNotFoundError:
            missing += 1
            print(f"  MISSING  {package}: pip install {package}")
    for module, remedy in OPTIONAL.items():
        try:
            importlib.import_module(module)
            print(f"  ok       {module} (optional)")
        except Exception as error:
            print(f"  absent   {module} (optional): {remedy} [{type(error).__name__}]")
    folder = given.results if given.results.exists() else Path.cwd()
    free = shutil.disk_usage(folder).free / 1e9
    print(f"  {'ok      ' if free > 1.0 else 'LOW     '} {free:.1f} GB free for {given.results}")
    writable = os.access(folder, os.W_OK)
    print(
        f"  {'ok      ' if writable else 'READ-ONLY'} {folder.resolve()} {'' if writable else ': choose results=FOLDER'}"
    )
    return 1 if missing or not writable else 0
