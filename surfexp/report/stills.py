"""The pictures of a page: inside it, so that it can be sent alone, or beside it where it would become too large."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping
from pathlib import Path
from urllib.parse import quote

# what many mail servers still carry
LARGEST_PAGE = 15_000_000
TYPES = {".png": "image/png", ".svg": "image/svg+xml"}


def addresses(folder: Path, names: Iterable[str], rest: int) -> tuple[dict[str, str], int]:
    """Return where a page finds its pictures, and the size that it would have with all of them inside.

    Parameters
    ----------
    folder : Path
        `figures` beside the page.
    names : iterable of str
        Files in it.
    rest : int
        Bytes of the page without pictures.

    Returns
    -------
    found : dict of str to str
        `data:` addresses; with pictures beyond 15 MB paths relative to the page.
    size : int
        Bytes.
    """
    files = {name: folder / name for name in names}
    size = rest + sum(4 * -(-file.stat().st_size // 3) for file in files.values())
    if size > LARGEST_PAGE:
        return {name: f"figures/{quote(name)}" for name in files}, size
    return {name: as_data(file.read_bytes(), TYPES[file.suffix]) for name, file in files.items()}, size


def as_data(content: bytes, kind: str) -> str:
    """Return bytes as a `data:` address of a media type.

    Examples
    --------
    >>> as_data(b"a,b", "text/csv")
    'data:text/csv;base64,YSxi'
    """
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def shown_files(pictures: Mapping[str, str]) -> bool:
    """Whether the pictures of a page stand beside it."""
    return any(not address.startswith("data:") for address in pictures.values())
