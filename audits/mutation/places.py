"""Every place of a source file where a fault can be planted, and the faults themselves."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from audits.mutation.change import Change

ARITHMETIC = {ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*")}
ARITHMETIC |= {ast.FloorDiv: ("//", "*"), ast.Mod: ("%", "//"), ast.Pow: ("**", "*"), ast.MatMult: ("@", "*")}
ARITHMETIC |= {ast.BitAnd: ("&", "|"), ast.BitOr: ("|", "&"), ast.LShift: ("<<", ">>"), ast.RShift: (">>", "<<")}
COMPARISONS: dict[type[ast.cmpop], tuple[str, tuple[str, ...]]] = {}
COMPARISONS |= {ast.Lt: ("<", ("<=", ">")), ast.LtE: ("<=", ("<", ">=")), ast.Gt: (">", (">=", "<"))}
COMPARISONS |= {ast.GtE: (">=", (">", "<=")), ast.Eq: ("==", ("!=",)), ast.NotEq: ("!=", ("==",))}
FUNCTIONS = {"min": "max", "minimum": "maximum", "argmin": "argmax", "any": "all", "sin": "cos", "floor": "ceil"}
FUNCTIONS |= {new: old for old, new in FUNCTIONS.items()}
SYMMETRIC = {"max", "min", "maximum", "minimum", "hypot", "isinstance", "array_equal", "cross_edges", "zip", "dot"}
# what speeds up or checks, and changes no result that is right
SKIPPED_KEYWORDS = {"strict", "copy", "check_finite", "overwrite_a", "overwrite_b", "stacklevel", "dtype", "order"}
# a guard against division by zero has no true size
SMALLEST, TOLERANCE = 1e-100, 1e-6


def changes(path: str, source: bytes) -> list[Change]:
    """Return every fault of a file: docstrings, annotations, decorators, texts and messages of errors are left alone."""
    return list(_Finder(path, source).visit(ast.parse(source)))


class _Finder:
    def __init__(self, path: str, source: bytes) -> None:
        self._path, self._source = path, source
        self._starts = [0]
        for line in source.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))

    def visit(self, node: ast.AST) -> Iterator[Change]:
        for start, end, new, kind in self._at(node):
            if new.encode() != self._source[start:end]:
                yield Change(self._path, start, end, new.encode(), kind)
        for child in _meaningful(node):
            yield from self.visit(child)

    def _at(self, node: ast.AST) -> Iterator[tuple[int, int, str, str]]:
        match node:
            case ast.BinOp(left, operator, right) if type(operator) in ARITHMETIC:
                yield self._between(left, right, *ARITHMETIC[type(operator)], "operator")
            case ast.AugAssign(target, operator, value):
                if type(operator) in ARITHMETIC:
                    yield self._between(target, value, *ARITHMETIC[type(operator)], "operator")
                yield (*self._span(node), "pass", "dropped statement")
            case ast.Compare(left, comparisons, right):
                for a, comparison, b in zip([left, *right], comparisons, right, strict=False):
                    if type(comparison) in COMPARISONS:
                        old, choices = COMPARISONS[type(comparison)]
                        yield from (self._between(a, b, old, new, "comparison") for new in choices)
            case ast.BoolOp(operator, values):
                old, new = ("and", "or") if isinstance(operator, ast.And) else ("or", "and")
                yield self._between(values[0], values[1], old, new, "comparison")
            case ast.UnaryOp(ast.USub() | ast.Not(), operand):
                yield (*self._span(node), self._text(operand), "sign")
            case ast.Constant(value):
                yield from ((*self._span(node), new, "constant") for new in _other_constants(value))
            case ast.Subscript(_, index):
                yield from self._indices(index)
            case ast.Call():
                yield from self._calls(node)
            case ast.If(test) | ast.IfExp(test):
                yield (*self._span(test), f"not ({self._text(test)})", "comparison")
            case ast.Expr(ast.Call()) | ast.Raise() | ast.Break() | ast.Continue():
                yield (*self._span(node), "pass", "dropped statement")
            case ast.Assign(targets) if any(isinstance(target, ast.Subscript | ast.Attribute) for target in targets):
                yield (*self._span(node), "pass", "dropped statement")

    def _indices(self, index: ast.expr) -> Iterator[tuple[int, int, str, str]]:
        match index:
            case ast.Tuple([ast.Name() as a, ast.Name() as b]):
                yield self._span(a)[0], self._span(b)[1], f"{self._text(b)}, {self._text(a)}", "index"
            case ast.Name():
                yield (*self._span(index), f"{index.id} - 1", "index")
        slices = index.elts if isinstance(index, ast.Tuple) else [index]
        for part in slices:
            if isinstance(part, ast.Slice):
                for bound in (part.lower, part.upper):
                    if bound is not None and not isinstance(bound, ast.Constant):
                        yield (*self._span(bound), f"({self._text(bound)}) + 1", "index")

    def _calls(self, node: ast.Call) -> Iterator[tuple[int, int, str, str]]:
        function = node.func
        name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        if name in FUNCTIONS:
            end = self._span(function)[1]
            yield end - len(name), end, FUNCTIONS[name], "function"
        match node.args:
            case [a, b, *_] if name not in SYMMETRIC and _place(a) and _place(b):
                yield self._span(a)[0], self._span(b)[1], f"{self._text(b)}, {self._text(a)}", "arguments"

    def _between(self, left: ast.expr, right: ast.expr, old: str, new: str, kind: str) -> tuple[int, int, str, str]:
        start, end = self._span(left)[1], self._span(right)[0]
        return start, end, self._source[start:end].decode().replace(old, new, 1), kind

    def _span(self, node: ast.expr | ast.stmt) -> tuple[int, int]:
        assert node.end_lineno is not None and node.end_col_offset is not None
        start = self._starts[node.lineno - 1] + node.col_offset
        return start, self._starts[node.end_lineno - 1] + node.end_col_offset

    def _text(self, node: ast.expr) -> str:
        start, end = self._span(node)
        return self._source[start:end].decode()


def _place(node: ast.expr) -> bool:
    return isinstance(node, ast.Name | ast.Attribute | ast.Subscript)


def _other_constants(value: object) -> list[str]:
    match value:
        case bool():
            return [str(not value)]
        case int():
            return [str(value + 1), str(value - 1)] if value else ["1"]
        case float() if value == 0.0:
            return ["1.0"]
        case float() if abs(value) >= SMALLEST:
            return [repr(value * 1e6)] if value < TOLERANCE else [repr(2.0 * value), repr(0.5 * value)]
    return []


def _meaningful(node: ast.AST) -> Iterator[ast.AST]:
    """The children that decide what is computed."""
    match node:
        case ast.FunctionDef(args=arguments, body=body):
            yield from (*arguments.defaults, *(default for default in arguments.kw_defaults if default), *body)
        case ast.AnnAssign(value=value):
            yield from [value] if value else []
        case ast.Raise() | ast.JoinedStr() | ast.Import() | ast.ImportFrom():
            return
        case ast.Assert(test=test):
            yield test
        case ast.ClassDef(body=body):
            yield from body
        case ast.keyword(arg=name) if name in SKIPPED_KEYWORDS:
            return
        case ast.UnaryOp(ast.USub(), ast.Constant()):
            return
        case _:
            yield from ast.iter_child_nodes(node)
