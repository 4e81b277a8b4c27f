"""The entrance for files of others: whatever their bytes provoke ends in one short line that begins with the file's name."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

LONGEST_REASON = 200


@contextmanager
def reading(path: Path | str, as_what: str) -> Iterator[None]:
    """Turn any exception into a ValueError with the file's name and a reason of at most 200 printable characters.

    Bytes that no format foresees make parsers, ours and those of others, raise whatever their expressions raise, from
    IndexError to MemoryError.

    Parameters
    ----------
    path : path
    as_what : str
        What was looked for, as "cannot be read as a mesh".

    Raises
    ------
    ValueError
        In place of what was raised.
    """
    try:
        yield
    except Exception as error:
        raise ValueError(f"{path} {as_what}: {reason(error)}") from error


def reason(error: BaseException) -> str:
    """Return what went wrong in one line that a terminal can show."""
    if isinstance(error, UnicodeDecodeError):
        return f"byte {error.start} is no {error.encoding.upper()} text"
    if isinstance(error, MemoryError):
        return "it says that it holds more than there is memory for"
    if isinstance(error, OverflowError):
        return "it holds a number that is too large"
    said = next(iter(str(error).splitlines()), "") or type(error).__name__
    shown = "".join(character if character.isprintable() else ascii(character)[1:-1] for character in said)
    if not isinstance(error, (ValueError, OSError)):
        shown = f"what it holds does not fit together ({type(error).__name__} {shown})"
    return shown if len(shown) <= LONGEST_REASON else f"{shown[: LONGEST_REASON - 4]} ..."
