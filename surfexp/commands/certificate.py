"""The certificate that a command writes beside its result: what was done, to which bytes, and what is proved."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from surfexp.io.replacing import replacing

LIBRARIES = ("surfexp", "numpy", "scipy", "numba", "nibabel")


def write_certificate(
    target: Path,
    method: str,
    options: dict[str, Any],
    inputs: Mapping[str, Any],
    facts: dict[str, Any],
    notes: tuple[str, ...],
) -> Path:
    """Write `TARGET.json` beside a result and return its path.

    Parameters
    ----------
    target : Path
        The result.
    method : str
    options : dict
        As they were used, defaults included.
    inputs : dict
        Files with the SHA-256 that their bytes had when they were read (`Inputs`), or keys of results by role.
    facts : dict
        What is proved and measured: `complete`, `residual`, `relative_gap`, `seconds`, ...
    notes : tuple of str
    """
    content = {
        "method": method,
        "options": options,
        "inputs": dict(inputs),
        "versions": _versions(),
        **facts,
        "notes": list(notes),
    }
    path = certificate_of(target)
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(_plain(content), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return path


def certificate_of(target: Path) -> Path:
    """Return where the certificate of a result stands."""
    return target.with_name(f"{target.name}.json")


class Inputs(dict[str, str]):
    """The files that went into a result, by path, each with the SHA-256 of its bytes when it was added: before it is read.

    `results` are the files that are to be written.
    """

    def __init__(self, *paths: Path | str) -> None:
        super().__init__()
        self.results: set[Path] = set()
        for path in paths:
            self.add(path)

    def add(self, path: Path | str) -> None:
        """Add a file; what is not there is left to its reader, who says so."""
        if Path(path).is_file():
            self[str(path)] = _sha256(Path(path))

    def refuse_to_overwrite(self, target: Path) -> None:
        """Refuse a result whose file, or whose certificate, is one of the inputs, or whose file is that of another result.

        Raises
        ------
        ValueError
            Naming it.
        """
        place = target.resolve()
        if place in self.results:
            raise ValueError(f"{target} is the file of two results: give each its own")
        self.results.add(place)
        for written in (target, certificate_of(target)):
            for path in self:
                if written.exists() and written.samefile(path):
                    raise ValueError(f"{target} would overwrite the input {path}: give another file")


def _sha256(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


@cache
def _versions() -> dict[str, str]:
    return {name: version(name) for name in LIBRARIES}


def _plain(value: Any) -> Any:
    """What JSON can say; numbers that are not finite, which it has no word for, as text."""
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if value is None or isinstance(value, bool | int | str):
        return value
    return value if isinstance(value, float) and math.isfinite(value) else str(value)
