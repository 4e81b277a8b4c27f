"""Sections of docs/reliability.md: each is written by itself, and the others stay as they are."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version

from audits.reliability import ROOT

PAGE = ROOT / "docs" / "reliability.md"
PACKAGES = ("numpy", "nibabel", "vtk", "trimesh", "meshio")


def write_section(heading: str, body: str) -> None:
    """Put a section in its place on the page, or behind the others."""
    text = PAGE.read_text(encoding="utf-8") if PAGE.exists() else "# Reliability\n"
    mark = f"\n## {heading}\n"
    before, found, rest = text.partition(mark)
    behind = rest.partition("\n## ")[1:] if found else ("", "")
    PAGE.write_text(f"{before.rstrip()}\n{mark}\n{body.strip()}\n{''.join(behind)}".rstrip() + "\n", encoding="utf-8")


def conditions() -> str:
    """Return versions and machine in one line."""
    found = []
    for package in PACKAGES:
        try:
            found.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            found.append(f"{package} not installed")
    return (
        f"Python {platform.python_version()} on {platform.machine()}, {os.cpu_count()} processors; {', '.join(found)}."
    )
