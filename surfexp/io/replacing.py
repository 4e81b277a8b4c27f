"""Files that are there whole or not at all: written under another name, flushed, renamed."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Yield a path of the same name in a folder beside a file; what was written there takes the file's place at the end.

    Formats are known by their names, so that the name stays. Where anything is raised, the file is as it was.

    Parameters
    ----------
    target : path
        What is no ordinary file, such as a pipe, is written to directly.

    Raises
    ------
    ValueError
        As `check_writable`.
    OSError
        With the file's name, as where the disk is full.
    """
    check_writable(target)
    if target.exists() and not target.is_file():
        yield target
        return
    place = target.resolve()
    with tempfile.TemporaryDirectory(prefix=".writing-", dir=place.parent) as folder:
        temporary = Path(folder) / target.name
        try:
            yield temporary
            with temporary.open("rb") as written:
                os.fsync(written.fileno())
        except OSError as error:
            # numpy says without a number that less was written than was asked for
            said = error.strerror or "no room for the whole file"
            raise OSError(error.errno or errno.ENOSPC, said, str(target)) from error
        if place.exists():
            temporary.chmod(place.stat().st_mode & 0o777)
        temporary.replace(place)


def check_writable(target: Path) -> None:
    """Refuse a file that cannot be written, before anything is computed.

    Raises
    ------
    ValueError
        If it is a folder, its folder is missing, or the folder cannot be written to.
    """
    if target.is_dir():
        raise ValueError(f"{target} is a folder: give the name of a file in it")
    folder = target.parent
    if not folder.is_dir():
        raise ValueError(f"{target} cannot be written: there is no folder {folder}; make it first")
    if not os.access(folder, os.W_OK) or (target.exists() and not os.access(target, os.W_OK)):
        raise ValueError(f"{target} cannot be written: permission denied; choose another folder")
