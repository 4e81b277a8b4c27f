"""What the digests of code need of a Python file, remembered for files of the same bytes: parsing takes most of a plan's time."""

from __future__ import annotations

import hashlib
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import NamedTuple

from surfexp import face
from surfexp.lab.plan import shown_text, source_code
from surfexp.lab.user_cache import Memory

_memory = Memory("source_facts")
# what a file was before it was read first, by which an edit is seen
_states: dict[Path, tuple[int, ...]] = {}


class SourceFacts(NamedTuple):
    """The meaning of a file, or of what one of its functions needs, what that imports, and the packages whose data it finds.

    `whole` says that all of the file counts, because no function was asked for or it cannot be told what it needs: then
    meaning, imports and data packages of a function are those of no statements.
    """

    meaning: str
    imports: frozenset[str]
    data_packages: frozenset[str]
    compiles: bool
    whole: bool


NOTHING = SourceFacts(source_code.meaning(()), frozenset(), frozenset(), False, True)


@cache
def source_facts(file: Path, function: str = "") -> SourceFacts:
    """Read a file, or remember what was found where one of the same name had the same bytes."""
    _states.setdefault(file, _state(file))
    data = file.read_bytes()
    place = f"{_analysis()} {'.'.join(source_code.dotted(file))} {function}\n"
    key = hashlib.sha256(place.encode() + data).hexdigest()
    if (known := _memory.get(key)) is not None:
        meaning, imports, data_packages, compiles, whole = known
        return SourceFacts(meaning, frozenset(imports), frozenset(data_packages), compiles, whole)
    needed = source_code.needed_by(file, function) if function else source_code.statements(file)
    part = needed or ()
    meaning, compiles, whole = source_code.meaning(part), b"njit" in data, not function or needed is None
    imports, data_packages = source_code.imported_modules(part, file), source_code.data_packages(part)
    _memory.put(key, [meaning, sorted(imports), sorted(data_packages), compiles, whole])
    return SourceFacts(meaning, imports, data_packages, compiles, whole)


def edited_files() -> list[Path]:
    """The files that are others than when this process read them first."""
    return [file for file, before in _states.items() if _state(file) != before]


def forget_files() -> None:
    """Read every file again when it is asked for."""
    _states.clear()
    source_facts.cache_clear()
    source_code.forget_statements()


def _state(file: Path) -> tuple[int, ...]:
    with suppress(OSError):
        facts = file.stat()
        return facts.st_ino, facts.st_size, facts.st_mtime_ns
    return ()


@cache
def _analysis() -> str:
    """State of what is remembered: of the code that reads files, the face, and Python, whose syntax trees differ by version."""
    files = (source_code.__file__, shown_text.__file__, __file__, face.__file__)
    code = b"".join(Path(str(file)).read_bytes() for file in files)
    return f"{sys.version_info[0]}.{sys.version_info[1]} {hashlib.sha256(code).hexdigest()}"
