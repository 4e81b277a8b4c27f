"""The files that options name: one, or several in a list or by name.

Each has the name of its option, and behind a point its place in the list or its own name: "path", "maps.sulc", "scans.0".
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, get_args, get_origin

from surfexp.lab.errors import UserError


def names_files(hint: Any) -> bool:
    """Whether a type is that of a path, or has one in it."""
    if isinstance(hint, type) and issubclass(hint, PathLike):
        return True
    return any(map(names_files, filter(None, (get_origin(hint), *get_args(hint)))))


def option_files(options: Mapping[str, Any], names: Iterable[str]) -> dict[str, str]:
    """The files that options of some names name, by name; UserError where they are nested deeper.

    Examples
    --------
    >>> option_files({"path": "a.off", "maps": {"sulc": "b.gii"}, "scans": ["c.npy"]}, ["path", "maps", "scans"])
    {'path': 'a.off', 'maps.sulc': 'b.gii', 'scans.0': 'c.npy'}
    """
    found: dict[str, Any] = {}
    for option in names:
        value = options.get(option)
        several = value if isinstance(value, Mapping) else dict(enumerate(value)) if isinstance(value, list) else None
        found |= {option: value} if several is None else {f"{option}.{key}": item for key, item in several.items()}
    for name, path in found.items():
        if not isinstance(path, str | None):
            raise UserError(
                f"{name} is {path!r}: files of an option are one, a list of them, or a dict of them by name"
            )
    return {name: path for name, path in found.items() if path is not None}


def file_named(options: Mapping[str, Any], name: str) -> str:
    """The file that `option_files` finds under a name."""
    return option_files(options, [name.partition(".")[0]])[name]


def with_file(options: Mapping[str, Any], name: str, path: str) -> dict[str, Any]:
    """Options with another file under a name.

    Examples
    --------
    >>> with_file({"scans": ["c.npy", "d.npy"]}, "scans.1", "e.npy")
    {'scans': ['c.npy', 'e.npy']}
    """
    option, _, key = name.partition(".")
    value = options[option]
    if isinstance(value, list):
        return {**options, option: [path if str(place) == key else item for place, item in enumerate(value)]}
    return {**options, option: {**value, key: path} if key else path}


def files_as_text(options: Mapping[str, Any], files: Iterable[str]) -> dict[str, str]:
    """The options that are text and name a file that exists, of which the contents do not count."""
    named = {name.partition(".")[0] for name in files}
    texts = {name: value for name, value in options.items() if isinstance(value, str) and name not in named}
    return {name: value for name, value in texts.items() if {".", "/"} & {*value} and _is_file(value)}


def _is_file(text: str) -> bool:
    try:
        return Path(text).is_file()
    except (OSError, ValueError):  # longer than a name can be, or no name at all
        return False
