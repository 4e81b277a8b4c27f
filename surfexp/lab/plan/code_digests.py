"""Digests of code, files and options, from which the key of a stage is made."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from surfexp.lab.digests import digest, file_digest
from surfexp.lab.plan.source_code import root_package
from surfexp.lab.plan.source_facts import NOTHING, edited_files, forget_files, source_facts
from surfexp.lab.registry.folders import STUDIES, shipped_sources
from surfexp.lab.registry.installed import changes_in_place, package_version

CODE_SUFFIXES = {".py", ".pyi", ".pyc", ".pyx", ".pxd", ".so", ".c", ".h"}
# the laboratory moves results, it does not make them; summaries and install hints only show
NOT_IN_KEYS = ("surfexp.lab", "surfexp.contract.summary", "surfexp.extras")
PACKAGE = Path(__file__).resolve().parents[2]


@cache
def code_closure(file: Path, function: str = "") -> tuple[frozenset[Path], frozenset[str]]:
    """Source files that a file reaches by import inside its own distributions, and the outside packages it reaches.

    Packages that are installed editable, or lie on the path without a version, count by their files as well.

    With the name of a function, only what that function needs of the file counts; the file itself is then among the files only
    if all of it counts. The framework is left out (it moves results, it does not make them), and so is the standard library.
    """
    own = frozenset({PACKAGE.name, STUDIES, root_package(file)})
    facts = source_facts(file, function)
    start, packages = (frozenset({file}), frozenset[str]()) if facts.whole else _reached(facts.imports, own)
    files, waiting = set[Path](), set(start)
    while waiting:
        here = waiting.pop()
        files.add(here)
        reached, outside = _reached_from(here, own)
        waiting |= reached - files
        packages |= outside
    return frozenset(files), packages


@cache
def _reached_from(file: Path, own: frozenset[str]) -> tuple[frozenset[Path], frozenset[str]]:
    return _reached(source_facts(file).imports, own)


def _reached(names: frozenset[str], own: frozenset[str]) -> tuple[frozenset[Path], frozenset[str]]:
    """Files of the modules that count by their source, and the roots of those of others outside the standard library.

    One's own distributions count by their source alone, and so, beside their version, do others that may change under it.
    """
    roots = {name: name.split(".")[0] for name in names}
    others = frozenset(roots.values()) - own - sys.stdlib_module_names
    sources = {*own, *filter(changes_in_place, others)}
    files = {found for name, root in roots.items() if root in sources for found in _module_files(name)}
    return frozenset(files), others


@cache
def code_digest(file: Path, function: str = "") -> str:
    """Digest of the meaning of everything a plugin reaches: comments, layout and docstrings do not count.

    Without the name of its function, or where it cannot be told what that needs, the whole file counts.
    """
    files, packages = code_closure(file, function)
    needed = source_facts(file, function) if function else NOTHING
    versions = {name: package_version(name) for name in packages}
    asked = needed.data_packages.union(*(source_facts(path).data_packages for path in files))
    data = {name: data_digest(name) for name in sorted(asked)}
    meanings = sorted(source_facts(path).meaning for path in files)
    return digest([needed.meaning, meanings, versions, *([data] if data else [])])


@cache
def data_digest(package: str) -> str:
    """Digest of all files of an installed package that are no code, empty when it is not installed."""
    specification = importlib.util.find_spec(package)
    if specification is None or not specification.submodule_search_locations:
        return ""
    folder = Path(next(iter(specification.submodule_search_locations)))
    files = sorted(file for file in folder.rglob("*") if file.is_file() and file.suffix not in CODE_SUFFIXES)
    return digest([(file.relative_to(folder).as_posix(), file_digest(file)) for file in files])


def check_code(planned: Iterable[tuple[Path, str, str]]) -> None:
    """Refuse code that is not what was planned: file, function and digest of each method.

    What this process, or the one it is a fork of, read first has to be what was planned, and so has what the files are now.
    Called before code is imported and when it has run, this holds for all that was imported in between.

    Raises
    ------
    RuntimeError
    """
    methods = list(planned)
    same = [code_digest(file, function) == code for file, function, code in methods]
    if all(same) and edited_files():
        forget_files()
        for remembered in (code_closure, _reached_from, code_digest, data_digest, _module_files):
            remembered.cache_clear()
        same = [code_digest(file, function) == code for file, function, code in methods]
    if not all(same):
        raise RuntimeError("the code was edited after this run was planned; run the same command again")


@cache
def compiled_state(file: Path = PACKAGE / "__init__.py") -> str:
    """Name of the compilation cache of a plugin: digest of every module that compiles and of all that it imports."""
    compiled = [path for path in (*shipped_sources(), *code_closure(file)[0]) if source_facts(path).compiles]
    meanings = sorted({source_facts(part).meaning for path in compiled for part in code_closure(path)[0]})
    return digest([meanings, package_version("numba"), sys.version_info[:2]])


@cache
def _module_files(name: str) -> tuple[Path, ...]:
    if name.startswith(NOT_IN_KEYS):
        return ()
    files, parts = [], name.split(".")
    # these parts of the package lie elsewhere in a checkout
    if parts[0] == PACKAGE.name and parts[1:2] not in (["plugins"], ["conf"], ["profiles"]):
        # the package itself only says where its public functions are; what is taken from it is found by its module
        places = [PACKAGE.joinpath(*parts[1:length]) for length in range(2, len(parts) + 1)]
        candidates = [file for place in places for file in (place / "__init__.py", place.with_suffix(".py"))]
        return tuple(file for file in candidates if file.is_file())
    for length in range(1, len(parts) + 1):
        try:
            specification = importlib.util.find_spec(".".join(parts[:length]))
        except (ImportError, ValueError, AttributeError):
            break
        if specification is None or not specification.origin or not specification.origin.endswith(".py"):
            continue
        files.append(Path(specification.origin).resolve())
    return tuple(files)
