"""The certificate that a command writes beside its result: what was done, to which bytes, and what is proved."""

from __future__ import annotations

import hashlib
import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

LIBRARIES = ("surfexp", "numpy", "scipy", "numba", "nibabel")


def write_certificate(
    target: Path,
    method: str,
    options: dict[str, Any],
    inputs: list[Path],
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
    inputs : list of Path
        Each enters with the SHA-256 of its bytes.
    facts : dict
        What is proved and measured: `complete`, `residual`, `relative_gap`, `seconds`, ...
    notes : tuple of str
    """
    content = {
        "method": method,
        "options": options,
        "inputs": {str(path): hashlib.sha256(path.read_bytes()).hexdigest() for path in inputs},
        "versions": {name: version(name) for name in LIBRARIES},
        **facts,
        "notes": list(notes),
    }
    path = target.with_name(f"{target.name}.json")
    path.write_text(json.dumps(content, indent=1, default=_plain, allow_nan=False) + "\n", encoding="utf-8")
    return path


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return str(value)
