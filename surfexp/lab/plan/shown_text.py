"""What code only shows to a person: no number depends on it, so it is left out of keys."""

from __future__ import annotations

import ast

DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
# methods by which a result shows itself at a prompt and in a notebook
SHOWING = {"__repr__", "_repr_html_", "_summary"}
# calls whose arguments describe, but for those named here: a metric's bound decides what counts as converged
DESCRIBING = {"Metric": {"bound"}}
# what of a plugin's registration has no part in its result
OF_EXPORTS = {"exports"}
DESCRIPTIONS = {"description", "title", "examples"}


def without_shown_text(tree: ast.Module) -> ast.Module:
    """Leave out docstrings, descriptions of options and metrics, what is exported, texts of errors, how results show themselves.

    Parameters
    ----------
    tree : ast.Module
        It is changed.

    Returns
    -------
    ast.Module
        The same tree.
    """
    computing: ast.Module = _WithoutShownText().visit(tree)
    return computing


class _WithoutShownText(ast.NodeTransformer):
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

    def visit_Call(self, node: ast.Call) -> ast.AST:
        name = getattr(node.func, "id", getattr(node.func, "attr", ""))
        if name in DESCRIBING:
            node.args = []
            node.keywords = [part for part in node.keywords if part.arg in DESCRIBING[name]]
        elif name == "Field":
            node.keywords = [part for part in node.keywords if part.arg not in DESCRIPTIONS]
        elif name == "register":
            node.keywords = [part for part in node.keywords if part.arg not in OF_EXPORTS]
        return self.generic_visit(node)
