"""The contract of results: arrays are real and finite, of the shapes and types that the result class documents.

A shape is read from the class's docstring, where it stands for people: "vectors : (n, k) float64". A letter is one
length throughout a result. A field whose values may be undefined is declared with `field(metadata={"nan": True})`.
"""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from scipy.sparse import issparse

PARAMETER = re.compile(r"^(\w[\w, ]*) : (?!tuple)(.*\b(?:float64|int64|int8|uint8|bool)\b.*)$", re.MULTILINE)
SHAPE = re.compile(r"\((\w+(?: \+ \d+)?(?:, ?\w+)*),?\)")


def check_result(result: Any, expected: type) -> None:
    """Refuse what is not a result of the expected class with finite real arrays of the documented shapes.

    Raises
    ------
    TypeError, ValueError
        Naming the field, what it holds and what was promised.
    """
    if not isinstance(result, expected):
        raise TypeError(f"returned {type(result).__name__}, a plugin of this kind returns {expected.__name__}")
    if dataclasses.is_dataclass(result):
        _check_fields(result, "", False)
        for name, value in getattr(result, "metrics", {}).items():
            if isinstance(value, bool | int | float | np.number) and not np.iscomplexobj(value):
                continue
            raise TypeError(f"metric {name!r} is {value!r} ({type(value).__name__}), a real number is expected")


def _check_fields(value: Any, path: str, undefined: bool) -> None:
    result: type = type(value)
    shapes, lengths = documented_shapes(result), dict[str, int]()
    for item in dataclasses.fields(value):
        here, name = getattr(value, item.name), f"{path}{item.name}"
        _check(here, name, undefined or bool(item.metadata.get("nan")))
        for part in here.values() if isinstance(here, Mapping) else [here]:
            if isinstance(part, np.ndarray) and part.size and item.name in shapes:
                _check_shape(part, name, shapes[item.name], lengths)


def _check(value: Any, name: str, undefined: bool) -> None:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        _check_fields(value, f"{name}.", undefined)
    elif isinstance(value, Mapping):
        for key, item in value.items():
            _check(item, f"{name}[{key!r}]", undefined)
    elif isinstance(value, tuple | list):
        for number, item in enumerate(value):
            _check(item, f"{name}[{number}]", undefined)
    elif issparse(value):
        _check(value.data, name, undefined)
    elif isinstance(value, np.ndarray | np.generic):
        if value.dtype.kind not in "fiub":
            raise TypeError(f"{name} holds {value.dtype}, real numbers are expected")
        bad = int((~np.isfinite(value)).sum()) - (int(np.isnan(value).sum()) if undefined else 0)
        if bad and isinstance(value, np.ndarray):
            raise ValueError(f"{name} has {bad} of {value.size} values that are not finite")


def _check_shape(array: np.ndarray, name: str, shapes: tuple[tuple[str, ...], ...], lengths: dict[str, int]) -> None:
    for shape in shapes:
        trial = dict(lengths)
        if len(shape) == array.ndim and all(
            trial.setdefault(length, found) == found
            if length.isalpha()
            else not length.isdigit() or int(length) == found
            for length, found in zip(shape, array.shape, strict=True)
        ):
            lengths.update(trial)
            return
    promised = " or ".join(f"({', '.join(shape)})" for shape in shapes)
    known_lengths = ", ".join(f"{length} = {found}" for length, found in lengths.items() if length in promised)
    raise ValueError(
        f"{name} has shape {array.shape}, {promised}{known_lengths and f' with {known_lengths}'} is promised"
    )


@cache
def documented_shapes(result: type) -> dict[str, tuple[tuple[str, ...], ...]]:
    """Shapes of the fields of a result class, in its docstring's letters; several where one "or" another is allowed."""
    found: dict[str, tuple[tuple[str, ...], ...]] = {}
    for text, described in PARAMETER.findall(inspect.getdoc(result) or ""):
        names = text.split(", ")
        shapes = tuple(tuple(re.split(r", ?", shape)) for shape in SHAPE.findall(described))
        each = [(shape,) for shape in shapes] if len(names) == len(shapes) > 1 else [shapes] * len(names)
        found.update({name: alternatives for name, alternatives in zip(names, each, strict=True) if alternatives})
    return found
