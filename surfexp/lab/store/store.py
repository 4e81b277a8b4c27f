"""The content-addressed store: one folder a result, written whole or not at all, the same bytes for the same key.

A record is sealed by the SHA-256 of its own text and names the SHA-256 of its arrays, its kind and its key, so that no
damage and no foreign file is read as a result.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.lab.errors import DamagedResult
from surfexp.lab.store.kinds import KINDS
from surfexp.lab.store.result_tree import decoded, encoded

HOST = os.uname().nodename  # processes of two machines that share a folder may have one number
RECORD, ARRAYS, ASIDE = "record.json", "arrays.npz", "record.aside.json"
# how keys are made; another word means that no key of before is one of now
KEYS = "of what computes"
SEAL = ',\n "sha256": "{}"\n}}\n'
SEAL_LENGTH = len(SEAL.format("0" * 64))


def result_folder(results: Path, kind: str, key: str) -> Path:
    """Folder of one result."""
    return results / "store" / kind / key


def is_done(results: Path, kind: str, key: str) -> bool:
    """Whether a finished result exists: the record is the last file to be written."""
    return (result_folder(results, kind, key) / RECORD).exists()


def note_on_older_keys(results: Path) -> str:
    """Mark the store as one of present keys; one line where results of older ones lie in it, which are computed again."""
    marker = results / "store" / "KEYS"
    if marker.exists() and marker.read_text() == KEYS:
        return ""
    older = any((results / "store").glob(f"*/*/{RECORD}"))
    write_text(marker, KEYS)
    said = f"results in {results / 'store'} have keys of an earlier version and are computed again"
    return f"{said}; `surfexp clean --older` removes the old ones" if older else ""


def write_text(path: Path, text: str) -> None:
    """Write a file under a temporary name and rename it, so that nobody reads half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with _replaced(path) as temporary:
        temporary.write_text(text)


@contextlib.contextmanager
def _replaced(path: Path) -> Iterator[Path]:
    """Yield a temporary name; what is written there takes the place of a file, or is removed where anything is raised.

    Unlike `surfexp.io.replacing` without a flush to the disk, which a plan of 10,000 stages would wait for: a result that a
    power cut damages is known by its digests and computed again.
    """
    temporary = path.with_name(f".{HOST}.{os.getpid()}.{path.name}")
    try:
        yield temporary
        temporary.rename(path)
    finally:
        temporary.unlink(missing_ok=True)


def save(results: Path, kind: str, key: str, result: Any) -> None:
    """Store a result dataclass: its arrays in `arrays.npz`, the rest as JSON; TypeError where it could not be read back."""
    arrays: dict[str, Any] = {}
    tree = encoded(result, "", arrays)
    if tree["class"] != kind:
        promised = KINDS[kind].result.__name__
        raise TypeError(
            f"returned {type(result).__name__}, which is stored as no {kind}: return {promised} itself, no subclass of it"
        )
    folder = result_folder(results, kind, key)
    folder.mkdir(parents=True, exist_ok=True)
    with _replaced(folder / ARRAYS) as temporary:
        np.savez(temporary, **arrays)
        record = {"arrays": _sha256(temporary), "key": key, "kind": kind, "result": tree}
    body = json.dumps(record, indent=1, sort_keys=True).removesuffix("\n}")
    write_text(folder / RECORD, body + _seal(body.encode()).decode())


def read_record(results: Path, kind: str, key: str) -> dict[str, Any]:
    """Return the record of a result: `arrays`, `kind`, `key`, and `result` as nested fields.

    Raises
    ------
    DamagedResult
        If there is none, or its seal, kind or key is not right.
    """
    file = result_folder(results, kind, key) / RECORD
    try:
        data = file.read_bytes()
    except OSError as error:
        raise DamagedResult(f"stored {kind}/{key} has no {RECORD} ({error.strerror})") from None
    if data[-SEAL_LENGTH:] != _seal(data[:-SEAL_LENGTH]):
        with contextlib.suppress(ValueError):
            if set(json.loads(data)) == {"class", "fields"}:
                raise DamagedResult(f"stored {kind}/{key} is of an earlier version, which stored no digests")
        raise DamagedResult(f"stored {kind}/{key} is damaged: {RECORD} does not have its own digest")
    record: dict[str, Any] = json.loads(data)
    if (record["kind"], record["key"], record["result"]["class"]) != (kind, key, kind):
        foreign = f"{record['kind']}/{record['key']} of class {record['result']['class']}"
        raise DamagedResult(f"stored {kind}/{key} is damaged: its {RECORD} is that of {foreign}")
    return record


def load(results: Path, kind: str, key: str, field: str | None = None) -> Any:
    """Read a result back, or one field of it (None where it has no such field); nothing is unpickled.

    Raises
    ------
    DamagedResult
        If the record or the arrays are not those that were written.
    """
    record = read_record(results, kind, key)
    tree = record["result"] if field is None else record["result"]["fields"].get(field)
    check_arrays(results, record)
    with np.load(result_folder(results, kind, key) / ARRAYS, allow_pickle=False) as arrays:
        return decoded(tree, arrays)


def check_arrays(results: Path, record: Mapping[str, Any]) -> None:
    """Hash the arrays of a record; DamagedResult when they are not those that were written with it."""
    name, file = f"{record['kind']}/{record['key']}", result_folder(results, record["kind"], record["key"]) / ARRAYS
    if not file.exists():
        raise DamagedResult(f"stored {name} is damaged: {ARRAYS} is missing")
    if _sha256(file) != record["arrays"]:
        raise DamagedResult(f"stored {name} is damaged: {ARRAYS} does not have the digest in {RECORD}")


def faults(results: Path, stages: Iterable[tuple[str, str]], anew: bool = False) -> dict[str, str]:
    """Why results cannot be used, by key: "" where there is none, else what is wrong; sound ones are left out.

    Arrays are hashed, except where `anew` is false and nothing about the file (size, times, inode) has changed since
    they were hashed last; whoever loads them hashes them in any case.
    """
    memory = results / "cache" / "verified.json"
    seen: dict[str, Any] = {}
    with contextlib.suppress(OSError, ValueError):
        seen = dict(json.loads(memory.read_text()))
    found, sound = {}, {}
    for kind, key in stages:
        if not is_done(results, kind, key):
            found[key] = ""
            continue
        try:
            record = read_record(results, kind, key)
            with contextlib.suppress(FileNotFoundError):
                state = (result_folder(results, kind, key) / ARRAYS).stat()
                times = [state.st_size, state.st_ino, state.st_mtime_ns, state.st_ctime_ns]
                sound[key] = [*times, record["arrays"]]
            if anew or key not in sound or seen.get(key) != sound[key]:
                check_arrays(results, record)
        except DamagedResult as error:
            sound.pop(key, None)
            found[key] = str(error)
    if any(seen.get(key) != state for key, state in sound.items()):
        with contextlib.suppress(OSError):
            write_text(memory, json.dumps(seen | sound))
    return found


def discard(results: Path, kind: str, key: str) -> None:
    """Remove a result and what an interrupted stage left beside it."""
    shutil.rmtree(result_folder(results, kind, key), ignore_errors=True)


def set_aside(results: Path, kind: str, key: str) -> None:
    """Let a sound result count as missing while it is made again; `take_back` ends that."""
    folder = result_folder(results, kind, key)
    (folder / RECORD).rename(folder / ASIDE)


def take_back(results: Path, stages: Iterable[tuple[str, str]]) -> None:
    """Let results that were set aside count again where no new one has taken their places, as after an interruption."""
    for kind, key in stages:
        aside = result_folder(results, kind, key) / ASIDE
        if is_done(results, kind, key):
            aside.unlink(missing_ok=True)
        elif aside.exists():
            aside.rename(aside.with_name(RECORD))


def _seal(body: bytes) -> bytes:
    return SEAL.format(hashlib.sha256(body).hexdigest()).encode()


def _sha256(file: Path) -> str:
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
