"""Which files of a folder are taken for meshes, by everything that reads folders."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

MESH_PATTERNS = ("*.off", "*.obj", "*.ply", "*.stl", "*.vtk", "*.vtp", "*.vtu", "*.vert", "*.surf.gii", "*.surf.gii.gz")


def files_called(folder: Path, patterns: Iterable[str] = MESH_PATTERNS) -> list[Path]:
    """Return the files below a folder whose name one of some patterns describes, in capitals or not.

    Parameters
    ----------
    folder : Path
    patterns : iterable of str
        Of the names of files, such as `*.off`, or of their paths, such as `left/*.off`.

    Returns
    -------
    list of Path
        In the order of their paths.

    Examples
    --------
    >>> from pathlib import Path
    >>> Path("BALL.OFF").touch()
    >>> [file.name for file in files_called(Path("."), ["*.off"])]
    ['BALL.OFF']
    """
    found = (file for pattern in patterns for file in folder.rglob(_in_any_case(pattern)))
    return sorted({file for file in found if file.is_file()})


def _in_any_case(pattern: str) -> str:
    """Return the pattern for small letters and capitals, unless it chooses among letters itself."""
    if "[" in pattern:
        return pattern
    return "".join(f"[{letter.lower()}{letter.upper()}]" if letter.isalpha() else letter for letter in pattern)
