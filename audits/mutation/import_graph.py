"""Which files a file imports, and which tests lie nearest to a module."""

from __future__ import annotations

import ast
from collections import deque
from functools import cache
from pathlib import Path

from audits.mutation import ROOT
from audits.mutation.change import source_of

# these start programs of their own, which know nothing of a fault in memory, or take minutes
OTHER_TESTS = {"commands", "lab", "report", "slurm", "tools", "test_plugins.py"}
PACKAGES = {"surfexp": "surfexp", "surfexp_studies": "studies"}


def numeric_tests() -> list[Path]:
    """Every test file of the numerics, and of the studies."""
    library = (ROOT / "tests").rglob("test_*.py")
    files = [path for path in library if path.relative_to(ROOT / "tests").parts[0] not in OTHER_TESTS]
    return sorted([*files, *(ROOT / "studies").glob("*/tests/test_*.py")])


@cache
def distances(test: Path) -> dict[Path, int]:
    """Return for each file that a test reaches the number of imports on the shortest way to it."""
    found, waiting = {test: 0}, deque([test])
    while waiting:
        here = waiting.popleft()
        for path in imported_files(here):
            if path not in found:
                found[path] = found[here] + 1
                waiting.append(path)
    return found


@cache
def imported_files(path: Path) -> frozenset[Path]:
    """Files of this checkout that a file imports anywhere in it, and the examples that it names."""
    tree = ast.parse(source_of(path))
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = imported_from(node, path)
            names.update((base, *(f"{base}.{alias.name}" for alias in node.names)))
    files = {file for name in names if (file := module_file(name)) is not None}
    helpers = {file for name in names if (file := path.parent / f"{name}.py").exists()}
    texts = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    examples: set[Path] = set()
    if texts & {"examples", "inside"}:
        functions = {node.name.removeprefix("test_") for node in tree.body if isinstance(node, ast.FunctionDef)}
        folders = (ROOT / "examples", ROOT / "docs" / "inside", path.parents[1] / "examples")
        shown = [file for folder in folders for file in folder.glob("*.py")]
        examples = {file for file in shown if file.stem in texts | functions}
    return frozenset(files | helpers | examples)


def imported_from(node: ast.ImportFrom, path: Path) -> str:
    """Dotted name of what a file imports from, relative ones resolved."""
    above = module_name(path).split(".")[: -node.level] if node.level else []
    return ".".join([*above, *([node.module] if node.module else [])])


@cache
def module_file(name: str) -> Path | None:
    """File of a module of the library or of a study, None for anything else."""
    package, *parts = name.split(".")
    if package not in PACKAGES:
        return None
    path = ROOT.joinpath(PACKAGES[package], *parts)
    return next((file for file in (path.with_suffix(".py"), path / "__init__.py") if file.exists()), None)


def module_name(path: Path) -> str:
    """Dotted name of a file of the library or of a study."""
    folder, *rest = path.relative_to(ROOT).with_suffix("").parts
    parts = (next((package for package, place in PACKAGES.items() if place == folder), folder), *rest)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def importers(target: Path) -> set[str]:
    """Dotted names of a module and of all modules that reach it by import."""
    return {module_name(path) for path in sources() if target in distances(path)}


def sources() -> list[Path]:
    """Every module of the library and of the studies."""
    return sorted([*(ROOT / "surfexp").rglob("*.py"), *(ROOT / "studies").glob("*/*.py")])
