"""Pairs of .vert and .tri files, as the TOSCA shapes come."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.mesh.triangle_mesh import Floats, Integers


def read_vert_tri(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of two text tables of three columns; `path` names either. Faces count from 1.

    Raises
    ------
    ValueError
        If one of the files is missing or is not such a table.
    """
    tables = []
    for suffix in (".vert", ".tri"):
        part = path.with_suffix(suffix)
        if not part.is_file():
            raise ValueError(f"the file {part.name} beside it is missing")
        rows = [line.split() for line in part.read_text("ascii", "replace").splitlines() if line.strip()]
        if not rows or any(len(row) != 3 for row in rows):
            raise ValueError(f"{part.name} is empty or has a row without three columns")
        tables.append(np.array(rows, dtype=np.float64))
    return tables[0], tables[1].astype(np.int64) - 1
