"""Digests of code, files and options, from which the key of a stage is made."""

from __future__ import annotations

import hashlib
import importlib.metadata
import importlib.util
import json
import sys
from functools import cache
from pathlib import Path
from typing import Any

from surfexp import source_code

distributions = cache(importlib.metadata.packages_distributions)
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
def code_closure(file: Path, function: str = "") -> tuple[frozenset[Path], frozenset[str]]:
    """Source files that a file reaches by import inside its own distributions, and the outside packages it reaches.

    With the name of a function, only what that function needs of the file counts; the file itself is then among the files only
    if all of it counts. The framework is left out (it moves results, it does not make them), and so is the standard library.
    """
    own = {"surfexp", source_code.root_package(file)}
    needed = source_code.needed_by(file, function) if function else None
    files: set[Path] = set()
    packages: set[str] = set()
    waiting = [file] if needed is None else _own_files(source_code.imported_modules(needed, file), own, packages)
    while waiting:
        here = waiting.pop()
        if here not in files:
            files.add(here)
            waiting += _own_files(_imported_names(here), own, packages)
    return frozenset(files), frozenset(packages)


def _own_files(names: frozenset[str], own: set[str], packages: set[str]) -> list[Path]:
    """Files of the modules of one's own distributions; the roots of the others are added to `packages`."""
    roots = {name: name.split(".")[0] for name in names}
    packages |= {root for root in roots.values() if root not in own and root not in sys.stdlib_module_names}
    return [found for name, root in roots.items() if root in own for found in _module_files(name)]


@cache
def code_digest(file: Path, function: str = "") -> str:
    """Digest of the meaning of everything a plugin reaches: comments, layout and docstrings do not count.

    Without the name of its function, or where it cannot be told what that needs, the whole file counts.
    """
    files, packages = code_closure(file, function)
    needed = (source_code.needed_by(file, function) if function else None) or ()
    versions = {name: package_version(name) for name in packages}
    asked = source_code.data_packages(needed).union(*map(_data_packages, files))
    data = {name: data_digest(name) for name in sorted(asked)}
    return digest([source_code.meaning(needed), sorted(map(meaning, files)), versions, *([data] if data else [])])


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
    return source_code.meaning(source_code.statements(path))


@cache
def _imported_names(file: Path) -> frozenset[str]:
    return source_code.imported_modules(source_code.statements(file), file)


@cache
def _data_packages(file: Path) -> frozenset[str]:
    return source_code.data_packages(source_code.statements(file))


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
