"""Tetrahedral meshes from files, as meshio reads them: VTK, gmsh, Abaqus, Medit and others."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.entrance import reading

# cells of lower dimension mark boundaries and regions
MARKS = {"vertex", "line", "line3", "triangle", "triangle6", "quad", "quad8", "quad9"}


def read_tetrahedra(path: Path | str) -> tuple[Floats, Integers, tuple[str, ...]]:
    """Read the tetrahedra of a file, without vertices that belong to none.

    Parameters
    ----------
    path : path
        Of a format that meshio reads.

    Returns
    -------
    vertices : (n, 3) float64
    tetrahedra : (m, 4) int64
    notes : tuple of str
        Says how many vertices were left out.

    Raises
    ------
    ValueError
        If the file cannot be read, or has cells with a volume that are no tetrahedra with four nodes.
    """
    from meshio import read

    with reading(path, "cannot be read as tetrahedra"):
        if not Path(path).is_file():
            raise FileNotFoundError("there is no such file")
        try:
            mesh = read(path)
        except SystemExit:  # meshio ends the process at what it does not know
            raise ValueError("meshio does not read this kind of file") from None
        kinds = {block.type for block in mesh.cells}
        if others := sorted(kinds - MARKS - {"tetra"}):
            raise ValueError(f"it has cells of kind {', '.join(others)}, tetrahedra with four nodes are needed")
        cells = [np.asarray(block.data, dtype=np.int64) for block in mesh.cells if block.type == "tetra"]
        if not cells:
            raise ValueError(f"it has no tetrahedra, its cells are: {', '.join(sorted(kinds)) or 'none'}")
        used, tetrahedra = np.unique(np.concatenate(cells), return_inverse=True)
        vertices = np.asarray(mesh.points, dtype=np.float64)[used]
    left = len(mesh.points) - len(used)
    notes = (f"{left} vertices of {path} belong to no tetrahedron and are left out.",) if left else ()
    return vertices, tetrahedra.reshape(-1, 4), notes
