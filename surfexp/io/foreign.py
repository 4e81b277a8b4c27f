"""The boundary to parsers that are not ours: whatever they raise on unfit bytes becomes one line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def parsing(what: str) -> Iterator[None]:
    """Turn any exception of a foreign parser into a ValueError that says that the file is not `what`.

    Parsers of binary and XML formats raise whatever the bytes provoke, from KeyError to their own classes; a list of them would
    never be complete.

    Parameters
    ----------
    what : str
        "a GIFTI file".

    Raises
    ------
    ValueError
        In place of what the parser raised.
    """
    try:
        yield
    except Exception as error:
        lines = str(error).splitlines()
        reason = lines[0] if lines else type(error).__name__
        raise ValueError(f"it is not a readable {what}: {reason[:160]}") from error
