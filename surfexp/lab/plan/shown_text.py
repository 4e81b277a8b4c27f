"""What code only shows to a person: no number depends on it, so it is left out of keys."""

from __future__ import annotations

import ast
from collections.abc import Mapping

DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
# methods by which a result shows itself at a prompt and in a notebook
SHOWING = {"__repr__", "_repr_html_", "_summary"}
METRIC = {"surfexp.contract.metric.Metric"}
# what alone of a metric counts: its bound decides what counts as converged
OF_METRICS = {"bound"}
OPTION = {"pydantic.Field", "pydantic.fields.Field"}
DESCRIPTIONS = {"description", "title", "examples"}
REGISTRATION = {"surfexp.lab.registry.registry.register"}
# what of a plugin's registration has no part in its result
OF_EXPORTS = {"exports"}


def without_shown_text(tree: ast.Module) -> ast.Module:
    """Leave out docstrings, descriptions of options and metrics, exports, arguments of `raise`, how results show themselves.

    Parameters
    ----------
    tree : ast.Module
        It is changed.

    Returns
    -------
    ast.Module
        The same tree.
    """
    computing: ast.Module = _WithoutShownText(_imported(tree)).visit(tree)
    return computing


def _imported(tree: ast.Module) -> dict[str, str]:
    """What names stand for that are imported absolutely: dotted names of modules and of what is in them."""
    found: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.asname or alias.name: alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            found |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    return found


class _WithoutShownText(ast.NodeTransformer):
    def __init__(self, imported: Mapping[str, str]) -> None:
        self.imported = imported

    def generic_visit(self, node: ast.AST) -> ast.AST:
        if isinstance(node, DOCUMENTED):
            if ast.get_docstring(node, clean=False) is not None:
                node.body = node.body[1:]
            if isinstance(node, ast.ClassDef):
                node.body = [part for part in node.body if getattr(part, "name", "") not in SHOWING]
        return super().generic_visit(node)

    def visit_Raise(self, node: ast.Raise) -> ast.AST:
        if isinstance(node.exc, ast.Call):
            return ast.Raise(node.exc.func, node.cause)
        return self.generic_visit(node)

    def _dotted(self, node: ast.expr) -> str:
        """The dotted name of what a name or an attribute is imported as, or not to be told."""
        if isinstance(node, ast.Name):
            return self.imported.get(node.id, "")
        if not isinstance(node, ast.Attribute):
            return ""
        written = ast.unparse(node.value) if isinstance(node.value, ast.Name | ast.Attribute) else ""
        return f"{self.imported.get(written, '')}.{node.attr}"

    def visit_Call(self, node: ast.Call) -> ast.AST:
        called = self._dotted(node.func)
        if called in METRIC:
            node.args = []
            node.keywords = [part for part in node.keywords if part.arg in OF_METRICS]
        elif called in OPTION:
            node.keywords = [part for part in node.keywords if part.arg not in DESCRIPTIONS]
        elif called in REGISTRATION:
            node.keywords = [part for part in node.keywords if part.arg not in OF_EXPORTS]
        return self.generic_visit(node)
