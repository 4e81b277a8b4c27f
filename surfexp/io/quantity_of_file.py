"""What a map is about, by the name of its file."""

from __future__ import annotations

from pathlib import Path

# ends of map files that say nothing of what the map is
FORMATS = (".gz", ".gii", ".nii", ".shape", ".func", ".dscalar", ".mgh", ".mgz", ".npz", ".npy", ".csv", ".txt")


def quantity_named(file: str) -> str:
    """Return what a map's file is about: its name without hemisphere and format.

    Examples
    --------
    >>> quantity_named("surf/lh.thickness"), quantity_named("clean.shape.gii"), quantity_named("sulc")
    ('thickness', 'clean', 'sulc')
    """
    name = Path(file).name
    for end in FORMATS:
        name = name.removesuffix(end)
    return name.removeprefix("lh.").removeprefix("rh.")
