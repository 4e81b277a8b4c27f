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

LIBRARIES = ("surfexp", "numpy", "scipy", "numba", "nibabel")


def write_certificate(
    target: Path,
    method: str,
    options: dict[str, Any],
    inputs: list[Path] | Mapping[str, Any],
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
    inputs : list of Path, or dict
        Each file enters with the SHA-256 of its bytes; a mapping as it is, such as keys of results by role.
    facts : dict
        What is proved and measured: `complete`, `residual`, `relative_gap`, `seconds`, ...
    notes : tuple of str
    """
    known = inputs if isinstance(inputs, Mapping) else {str(path): _sha256(path) for path in inputs}
    content = {
        "method": method,
        "options": options,
        "inputs": known,
        "versions": _versions(),
        **facts,
        "notes": list(notes),
    }
    path = target.with_name(f"{target.name}.json")
    path.write_text(json.dumps(_plain(content), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return path


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


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
