"""Digests of values and of files."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from pathlib import Path
from typing import Any


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
