"""All plugins by kind and name, described without importing them: the description is renewed when a file changes."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from surfexp.lab.registry.contained import contained_description
from surfexp.lab.registry.described import Described
from surfexp.lab.registry.folders import entry_points_of_plugins, sources
from surfexp.lab.registry.imported import file_facts
from surfexp.lab.registry.installed import installed_state
from surfexp.lab.store.kinds import stage_kind
from surfexp.lab.user_cache import Memory

# every state of the code has an entry of its own, and they are large
STATES_KEPT = 8
_memory = Memory("plugins", STATES_KEPT)


@dataclass(frozen=True)
class Catalogue:
    """Plugins by kind and name, the stage kinds in order with their result types, and what could not be loaded by file.

    `certified` are the kinds whose results say whether they converged.
    """

    plugins: dict[tuple[str, str], Described]
    kinds: dict[str, tuple[str, bool]]
    broken: dict[str, str]
    certified: frozenset[str]

    def names(self, kind: str) -> list[str]:
        """Names of the plugins of a kind."""
        return [name for of, name in self.plugins if of == kind]


@cache
def catalogue(working_folder: Path) -> Catalogue:
    """What there is to choose from in a working folder; UserError where two plugins have one name."""
    if (found := remembered(working_folder)) is not None:
        return found
    known = contained_description(working_folder)
    # what failed may work the next time, for another reason than a changed file; what hangs is not waited for again
    if set(known["broken"]) <= set(known.pop("contained")):
        _memory.put(code_state(working_folder), known)
    return _read(known)


@cache
def remembered(working_folder: Path) -> Catalogue | None:
    """The catalogue of a working folder where it is known without loading a plugin, else None."""
    known = _memory.get(code_state(working_folder))
    return _read(known) if known and _unchanged(known["imported"]) else None


def _unchanged(imported: dict[str, list[int]]) -> bool:
    """Whether what plugins import from elsewhere, of which `code_state` does not know, is what it was."""
    return all(file_facts(Path(file)) == facts for file, facts in imported.items())


def _read(known: dict[str, Any]) -> Catalogue:
    plugins = {(item["kind"], item["name"]): Described(**item) for item in known["plugins"]}
    kinds = {name: (path, stored) for name, path, stored in known["kinds"]}
    return Catalogue(plugins, kinds, known["broken"], frozenset(known["certified"]))


@cache
def code_state(working_folder: Path) -> str:
    """Digest of the names, sizes and times of all files that plugins are made of, and of what is installed."""
    facts = [(str(file), *file_facts(file)) for file in sources(working_folder)]
    points = sorted(f"{point.name}={point.value}" for point in entry_points_of_plugins())
    return hashlib.sha256(repr((facts, points, installed_state())).encode()).hexdigest()


def open_catalogue(working_folder: Path) -> Catalogue:
    """Make every plugin known without loading it: its file is loaded when it is looked up."""
    from surfexp.lab.registry import registry  # which takes pydantic; the catalogue is read without

    known = catalogue(working_folder)
    for name, (path, stored) in known.kinds.items():
        stage_kind(name, path, stored)
    registry.DESCRIBED.update({key: Path(item.file) for key, item in known.plugins.items()})
    registry.BROKEN.update({Path(file): message for file, message in known.broken.items()})
    return known
