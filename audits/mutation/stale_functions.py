"""Compiled functions that a fault changes: numba's cache on disk watches only the file that a function stands in."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from audits.mutation import ROOT
from audits.mutation.change import Change, source_of
from audits.mutation.import_graph import imported_from, module_name, sources

Definition = tuple[str, str]
COMPILERS = ("njit", "jit", "intrinsic", "overload", "vectorize")


@dataclass(frozen=True)
class _Use:
    """A definition at the top of a module: whether it is compiled or a value, and the definitions that it names."""

    lasting: bool
    uses: frozenset[Definition]


def stale_functions(change: Change) -> frozenset[Definition]:
    """Return (module, name) of every compiled function that has to be compiled afresh; none if the fault is in plain code.

    A compiled function sees compiled functions and values of modules, never a plain function.
    """
    path = ROOT / change.path
    line = change.line
    name = next(
        (found for node in ast.parse(source_of(path)).body if node.lineno <= line <= (node.end_lineno or 0)
         for found in _names(node)),
        "",
    )  # fmt: skip
    stale = {(module_name(path), name)}
    table = _definitions()
    while grown := {key for key, use in table.items() if use.lasting and key not in stale and use.uses & stale}:
        stale |= grown
    return frozenset(key for key in stale if key in table and table[key].lasting)


@cache
def _definitions() -> dict[Definition, _Use]:
    table: dict[Definition, _Use] = {}
    for path in sources():
        tree, module = ast.parse(source_of(path)), module_name(path)
        names = _imported(tree, path) | {name: (module, name) for node in tree.body for name in _names(node)}
        for node in tree.body:
            inside = {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}
            for name in _names(node):
                uses = frozenset(names[word] for word in inside - {name} if word in names)
                table[module, name] = _Use(_lasting(node), uses)
    return table


def _imported(tree: ast.Module, path: Path) -> dict[str, Definition]:
    return {
        alias.asname or alias.name: (imported_from(node, path), alias.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }


def _names(node: ast.stmt) -> list[str]:
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return [name]
        case ast.Assign() | ast.AnnAssign():
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            return [part.id for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)]
    return []


def _lasting(node: ast.stmt) -> bool:
    """Whether a definition is compiled, makes compiled functions, or is a value."""
    if isinstance(node, ast.FunctionDef):
        functions = [part for part in ast.walk(node) if isinstance(part, ast.FunctionDef)]
        decorators = [ast.unparse(decorator) for function in functions for decorator in function.decorator_list]
        return any(word in decorator for decorator in decorators for word in COMPILERS)
    return not isinstance(node, ast.ClassDef)
