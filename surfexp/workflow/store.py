"""The content-addressed store: one folder a result, written whole or not at all, the same bytes for the same key."""

from __future__ import annotations

import dataclasses
import importlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import csr_array, issparse

from surfexp.workflow.kinds import KINDS, path_of

RECORD = "record.json"


def result_folder(results: Path, kind: str, key: str) -> Path:
    """Folder of one result."""
    return results / "store" / kind / key


def is_done(results: Path, kind: str, key: str) -> bool:
    """Whether a finished result exists: the record is the last file to be written."""
    return (result_folder(results, kind, key) / RECORD).exists()


def write_text(path: Path, text: str) -> None:
    """Write a file under a temporary name and rename it, so that nobody reads half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    temporary.write_text(text)
    temporary.rename(path)


def save(results: Path, kind: str, key: str, result: Any) -> None:
    """Store a result dataclass: its arrays in `arrays.npz`, the rest as JSON."""
    arrays: dict[str, Any] = {}
    tree = _encode(result, "", arrays)
    folder = result_folder(results, kind, key)
    folder.mkdir(parents=True, exist_ok=True)
    temporary = folder / f".arrays.{os.getpid()}.npz"
    np.savez(temporary, **arrays)
    temporary.rename(folder / "arrays.npz")
    write_text(folder / RECORD, json.dumps(tree, indent=1, sort_keys=True) + "\n")


def load(results: Path, kind: str, key: str) -> Any:
    """Read a result back; nothing is unpickled."""
    folder = result_folder(results, kind, key)
    tree = json.loads((folder / RECORD).read_text())
    with np.load(folder / "arrays.npz", allow_pickle=False) as arrays:
        return _decode(tree, arrays)


def _encode(value: Any, path: str, arrays: dict[str, Any]) -> Any:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        path_of_class = path_of(type(value))
        kind = next((kind.name for kind in KINDS.values() if kind.path == path_of_class), None)
        names = [item.name for item in dataclasses.fields(value)]
        fields = {name: _encode(getattr(value, name), f"{path}/{name}", arrays) for name in names}
        return {"class": kind or path_of_class, "fields": fields}
    if issparse(value):
        matrix = value.tocsr()
        parts = {"data": matrix.data, "indices": matrix.indices, "indptr": matrix.indptr}
        return {"sparse": _encode(parts, path, arrays), "shape": list(matrix.shape)}
    if isinstance(value, np.ndarray):
        arrays[path.strip("/")] = value
        return {"array": path.strip("/")}
    if isinstance(value, Mapping):
        return {"map": {str(key): _encode(item, f"{path}/{key}", arrays) for key, item in value.items()}}
    if isinstance(value, tuple | list):
        items = [_encode(item, f"{path}/{i}", arrays) for i, item in enumerate(value)]
        return {"tuple": items} if isinstance(value, tuple) else items
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, str | int | float | bool):
        return value
    raise TypeError(f"{path.strip('/') or 'result'} is a {type(value).__name__}, which the store does not keep")


def _decode(tree: Any, arrays: Any) -> Any:
    if isinstance(tree, list):
        return [_decode(item, arrays) for item in tree]
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return arrays[tree["array"]]
    if "map" in tree:
        return {key: _decode(item, arrays) for key, item in tree["map"].items()}
    if "tuple" in tree:
        return tuple(_decode(item, arrays) for item in tree["tuple"])
    if "sparse" in tree:
        parts = _decode(tree["sparse"], arrays)
        return csr_array((parts["data"], parts["indices"], parts["indptr"]), shape=tuple(tree["shape"]))
    module, _, name = tree["class"].partition(":")
    cls = getattr(importlib.import_module(module), name) if name else KINDS[module].result
    if not dataclasses.is_dataclass(cls):
        raise TypeError(f"stored class {tree['class']} is not a dataclass")
    return cls(**{key: _decode(item, arrays) for key, item in tree["fields"].items()})
