"""Which files a file imports, and which tests lie nearest to a module."""

from __future__ import annotations

import ast
from collections import deque
from functools import cache
from pathlib import Path

from mutation import ROOT
from mutation.change import source_of

# these start programs of their own, which know nothing of a fault in memory, or take minutes
OTHER_TESTS = {"workflow", "report", "tools", "test_plugins.py"}


def numeric_tests() -> list[Path]:
    """Every test file of the numerics."""
    files = (ROOT / "tests").rglob("test_*.py")
    return sorted(path for path in files if path.relative_to(ROOT / "tests").parts[0] not in OTHER_TESTS)


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
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names.update((node.module, *(f"{node.module}.{alias.name}" for alias in node.names)))
    files = {file for name in names if (file := module_file(name)) is not None}
    helpers = {file for name in names if (file := path.parent / f"{name}.py").exists()}
    texts = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    examples: set[Path] = set()
    if texts & {"examples", "inside"}:
        functions = {node.name.removeprefix("test_") for node in tree.body if isinstance(node, ast.FunctionDef)}
        shown = [*(ROOT / "examples").glob("*.py"), *(ROOT / "docs" / "inside").glob("*.py")]
        examples = {file for file in shown if file.stem in texts | functions}
    return frozenset(files | helpers | examples)


@cache
def module_file(name: str) -> Path | None:
    """File of a module of this package, None for anything else."""
    if name.split(".")[0] != "surfexp":
        return None
    path = ROOT.joinpath(*name.split("."))
    return next((file for file in (path.with_suffix(".py"), path / "__init__.py") if file.exists()), None)


def module_name(path: Path) -> str:
    """Dotted name of a file of this package."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def importers(target: Path) -> set[str]:
    """Dotted names of a module and of all modules that reach it by import."""
    files = (ROOT / "surfexp").rglob("*.py")
    return {module_name(path) for path in files if target in distances(path)}
