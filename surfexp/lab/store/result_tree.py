"""Results as nested JSON with their arrays beside it, and back; nothing is pickled, and no code of a stranger is imported."""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from surfexp.lab.errors import DamagedResult
from surfexp.lab.store.kinds import KINDS, path_of

# types of the keys of a mapping, by the name under which they are stored
KEYS = {"str": str, "int": int | np.integer, "float": float | np.floating}


def encoded(value: Any, path: str, arrays: dict[str, Any]) -> Any:
    """JSON of a value, its arrays put into `arrays` under their paths; TypeError naming the path of what has no form."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        path_of_class = path_of(type(value))
        kind = next((kind.name for kind in KINDS.values() if kind.path == path_of_class), None)
        _check_readable(kind or path_of_class, path)
        names = [item.name for item in dataclasses.fields(value)]
        fields = {name: encoded(getattr(value, name), f"{path}/{name}", arrays) for name in names}
        return {"class": kind or path_of_class, "fields": fields}
    if hasattr(value, "tocsr"):
        matrix = value.tocsr()
        parts = {"data": matrix.data, "indices": matrix.indices, "indptr": matrix.indptr}
        return {"sparse": encoded(parts, path, arrays), "shape": list(matrix.shape)}
    if isinstance(value, np.ndarray):
        arrays[path.strip("/")] = value
        return {"array": path.strip("/")}
    if isinstance(value, Mapping):
        items = {str(key): encoded(item, f"{path}/{key}", arrays) for key, item in value.items()}
        types = {next((kind for kind, of in KEYS.items() if isinstance(key, of)), "") for key in value} or {"str"}
        if len(types) > 1 or not KEYS.keys() & types:
            raise TypeError(
                f"{path.strip('/') or 'result'} has keys {list(value)[:3]}: numbers or text, all of one type"
            )
        return {"map": items} if types == {"str"} else {"map": items, "keys": types.pop()}
    if isinstance(value, tuple | list):
        listed = [encoded(item, f"{path}/{i}", arrays) for i, item in enumerate(value)]
        return {"tuple": listed} if isinstance(value, tuple) else listed
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, str | int | float | bool):
        return value
    raise TypeError(f"{path.strip('/') or 'result'} is a {type(value).__name__}, which the store does not keep")


def decoded(tree: Any, arrays: Any) -> Any:
    """The value whose JSON this is; DamagedResult if it names a class that no stage kind is made of."""
    if isinstance(tree, list):
        return [decoded(item, arrays) for item in tree]
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return arrays[tree["array"]]
    if "map" in tree:
        restored = {"int": int, "float": float}.get(tree.get("keys", ""), str)
        return {restored(key): decoded(item, arrays) for key, item in tree["map"].items()}
    if "tuple" in tree:
        return tuple(decoded(item, arrays) for item in tree["tuple"])
    if "sparse" in tree:
        from scipy.sparse import csr_array  # takes longer than all else that a run with nothing to do imports

        parts = decoded(tree["sparse"], arrays)
        return csr_array((parts["data"], parts["indices"], parts["indptr"]), shape=tuple(tree["shape"]))
    cls = _result_class(tree["class"])
    return cls(**{key: decoded(item, arrays) for key, item in tree["fields"].items()})


def _check_readable(name: str, path: str) -> None:
    try:
        _result_class(name)
    except DamagedResult as error:
        raise TypeError(f"{path.strip('/') or 'result'} could not be read back: {error}") from None


def _result_class(name: str) -> type:
    """The dataclass of a kind, or one of a package that declares a kind: no other module is imported."""
    if name in KINDS:
        return KINDS[name].result
    module, _, attribute = name.partition(":")
    if module.split(".")[0] not in {"surfexp", *(kind.path.partition(":")[0].split(".")[0] for kind in KINDS.values())}:
        raise DamagedResult(f"stored class {name!r} is of no package that declares a stage kind: it is not imported")
    found = getattr(importlib.import_module(module), attribute, None)
    if not (isinstance(found, type) and dataclasses.is_dataclass(found)):
        raise DamagedResult(f"stored class {name!r} is not a dataclass")
    return found
