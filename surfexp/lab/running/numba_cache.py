"""Numba's disk cache for many processes at once: no file has two writers, damage is compiled again, a full disk is no failure.

Numba imports this module itself, by the name in NUMBA_CACHE_LOCATOR_CLASSES, before it caches its first function.
"""

from __future__ import annotations

import hashlib
import pickle
import uuid
from pathlib import Path
from typing import Any

from numba.core import caching

UNREADABLE = (ValueError, EOFError, OSError, pickle.UnpicklingError)
complaints: dict[str, None] = {}


class CheckedFolder(caching.UserProvidedCacheLocator):
    """The folder of NUMBA_CACHE_DIR."""


# what is taken from inside numba; where a version has it no longer, numba keeps its files by itself
INSIDE = ("save", "load", "_load_index", "_load_data", "_data_name", "_dump", "_data_path")
_Files: Any = getattr(caching, "IndexDataCacheFile", object)


class CheckedFiles(_Files):
    """Index and code files of one function, each with its digest; what cannot be read or written is left out.

    Numba numbers code files by the index that it has read: two processes that compile one function for two signatures
    would write one file, and the index would give the code of one for the other. Here each file has a name of its own;
    what two writers lose is at most an entry of the index.
    """

    def save(self, key: Any, data: Any) -> None:
        """Write the code of one signature, if that is possible."""
        try:
            super().save(key, data)
        except OSError as error:
            _complain(f"compiled code cannot be kept in {self._cache_path}: {error.strerror}")

    def load(self, key: Any) -> Any:
        """Read the code of one signature; None where there is none, or it is damaged."""
        try:
            return super().load(key)
        except UNREADABLE as error:
            _complain(f"damaged compiled code in {self._cache_path} is not used: {error}")
            return None

    def _load_index(self) -> Any:
        try:
            with Path(self._index_path).open("rb") as file:
                pickle.load(file)  # noqa: S301, numba's version, in a folder that only the user can write
                _check(file.read(), self._index_path)
            return super()._load_index()
        except FileNotFoundError:
            return {}
        except UNREADABLE as error:
            _complain(f"damaged compiled code in {self._cache_path} is not used: {error}")
            return {}

    def _load_data(self, name: str) -> Any:
        _check(Path(self._data_path(name)).read_bytes(), name)
        return super()._load_data(name)

    def _data_name(self, number: int) -> str:
        return super()._data_name(number).removesuffix(".nbc") + f".{uuid.uuid4().hex[:12]}.nbc"

    def _dump(self, value: Any) -> bytes:
        data: bytes = super()._dump(value)
        return data + hashlib.sha256(data).digest()


def _check(data: bytes, file: str) -> None:
    if hashlib.sha256(data[:-32]).digest() != data[-32:]:
        raise ValueError(f"{Path(file).name} does not have its own digest")


def _complain(text: str) -> None:
    complaints.setdefault(text)


if all(hasattr(_Files, name) for name in INSIDE):
    caching.IndexDataCacheFile = CheckedFiles
else:
    _complain("this version of numba keeps compiled code in its own way: its files are not checked for damage")
