"""A surface as its file has it, defects included."""

from __future__ import annotations

from pathlib import Path

from surfexp.io.hemisphere import hemisphere_of_file
from surfexp.io.reading import read_mesh_file
from surfexp.mesh.surface import BOTH, Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.surface_file import PathLike, _unit_of, maps_of_file


def stored_surface(path: PathLike, hemisphere: str = "") -> Surface:
    """Return the surface of a file with all that `surfexp.read` finds in it, and with its defects.

    Parameters
    ----------
    path : path
    hemisphere : {"", "left", "right"}
        Overrides what the file says.

    Raises
    ------
    ValueError
        If the file cannot be read, or holds both hemispheres where one is given.
    """
    file = read_mesh_file(path)
    facts = file.facts
    if facts.right is not None and hemisphere:
        raise ValueError(f"hemisphere {hemisphere} names one side, {path} is both: leave it out")
    maps, left_out = maps_of_file(file, path)
    return Surface(
        TriangleMesh(file.vertices, file.faces),
        Path(path).stem,
        facts.unit or _unit_of(file.frame),
        maps,
        mask=facts.mask,
        hemisphere=BOTH if facts.right is not None else hemisphere or hemisphere_of_file(path),
        labels=dict(facts.labels),
        notes=(*file.notes, *left_out),
        frame=file.frame,
        right=facts.right,
    )
