"""Surfaces and results as files: the suffix decides about the format."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.io.label_files import write_labels
from surfexp.io.map_files import check_map_target, mask_notes, read_maps, read_mask, read_named_labels, write_maps
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.reading import hemisphere_of_file, read_mesh_file
from surfexp.io.replacing import check_writable, replacing
from surfexp.io.writing import WITH_MAPS, write_mesh
from surfexp.mesh.given_arrays import map_array, mask_array
from surfexp.mesh.given_numbers import one_of
from surfexp.mesh.repair import repair as repair_mesh
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.soundness import sound_part

PathLike = str | Path
LABEL_SUFFIXES = (".label.gii", ".annot")


def read(
    path: PathLike,
    *,
    maps: Mapping[str, PathLike] | None = None,
    labels: Mapping[str, PathLike] | None = None,
    mask: PathLike | np.ndarray | None = None,
    unit: str = "",
    hemisphere: str = "",
    repair: bool = False,
) -> Surface:
    """Read a surface with its maps, labels and mask.

    Parameters
    ----------
    path : path
        OFF, OBJ, PLY, STL, VTK (.vtk, .vtp, .vtu), GIFTI, npz, FreeSurfer geometry, .vert/.tri.
    maps : dict of name to path, optional
        GIFTI, CIFTI-2, .mgh/.mgz, FreeSurfer curvature, .npy/.npz, .csv, text. A file with several maps gives each its own name.
    labels : dict of name to path, optional
        .label.gii, .annot, .dlabel.nii.
    mask : path or (n,) array, optional
        A FreeSurfer .label, named labels (all but unknown and medial wall, or `FILE:NAME,NAME`), or a map that is 0 outside.
    unit : str
        Unit of length.
    hemisphere : {"", "left", "right"}
        Taken from the file where it says so. Files of the other hemisphere are refused.
    repair : bool
        Repair a defective mesh instead of refusing it, with a note for each change. Maps follow their vertices. Vertices
        without faces or position are no defect: they count as outside, and the numbering stays.

    Returns
    -------
    Surface

    Raises
    ------
    ValueError
        If a file cannot be read, does not fit, or the mesh has a defect that a method cannot work with.

    Examples
    --------
    >>> import surfexp as sx
    >>> sx.write("ball.ply", sx.shape("icosphere", levels=2))
    >>> len(sx.read("ball.ply").mesh.faces)
    320
    """
    if hemisphere != "":
        one_of(hemisphere, "hemisphere", HEMISPHERES)
    file_read = read_mesh_file(Path(path))
    vertices, faces, scalars = file_read.vertices, file_read.faces, scalar_channels(file_read.scalars)
    count = len(vertices)
    side = hemisphere or hemisphere_of_file(path)
    for name, file in (maps or {}).items():
        _same_side(file, side, f"map {name!r}")
        scalars |= _named(name, read_maps(file, side), count, file)
    for name, file in (labels or {}).items():
        _same_side(file, side, f"labels {name!r}")
    tables = {name: read_named_labels(file, side) for name, file in (labels or {}).items()}
    for name, table in tables.items():
        if len(table.keys) != count:
            raise ValueError(f"labels {name!r} have {len(table.keys)} entries, {path} has {count} vertices")
    notes = file_read.notes
    if isinstance(mask, str | Path):
        _same_side(mask, side, "mask")
        notes = (*notes, *mask_notes(mask, side))
        mask = read_mask(mask, count, side)
    inside = None if mask is None else mask_array(mask, count)
    surface = Surface(
        TriangleMesh(vertices, faces),
        Path(path).stem,
        unit,
        scalars,
        mask=inside,
        hemisphere=side,
        labels=tables,
        notes=notes,
        frame=file_read.frame,
    )
    try:
        return sound_part(surface, str(path), repair="")
    except ValueError:
        if not repair:
            raise
    return sound_part(_repaired(surface), str(path), repair="")


def _repaired(surface: Surface) -> Surface:
    mesh, changes, origin = repair_mesh(surface.mesh.vertices, surface.mesh.faces)
    return replace(
        surface,
        mesh=mesh,
        scalars={name: values[origin] for name, values in surface.scalars.items()},
        labels={name: replace(table, keys=table.keys[origin]) for name, table in surface.labels.items()},
        mask=None if surface.mask is None else surface.mask[origin],
        notes=(*surface.notes, *changes),
    )


def _same_side(file: PathLike, side: str, what: str) -> None:
    """Refuse a file of the other hemisphere."""
    of_file = hemisphere_of_file(str(file).partition(":")[0]) if side else ""
    if of_file and of_file != side:
        raise ValueError(
            f"{what} {file} is of the {of_file} hemisphere, the surface of the {side}: give the file of the {side} one"
        )


def _named(name: str, maps: dict[str, Floats], count: int, file: PathLike) -> dict[str, Floats]:
    for values in maps.values():
        if len(values) != count:
            raise ValueError(f"map {file} has {len(values)} values, the surface has {count} vertices")
    named = {name: next(iter(maps.values()))} if len(maps) == 1 else {f"{name} {key}": v for key, v in maps.items()}
    return scalar_channels(named)


def write(path: PathLike, what: Any, surface: Surface | None = None) -> None:
    """Write a surface, a map, or a result; the suffix decides the format.

    Parameters
    ----------
    path : path
    what : Surface, (n,) or (n, c) array, dict of name to array, or a result (a denoised map, eigenpairs, a segmentation, ...)
        Eigenpairs become maps "mode 0", "mode 1", ... and in .npz `values`, `vectors`, `residuals`.
    surface : Surface, optional
        For formats that hold the geometry beside the map (.ply, .vtk, .vtp), and for the hemisphere in GIFTI and CIFTI files.

    Raises
    ------
    ValueError
        If the format is unknown or cannot hold the data.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=2)
    >>> sx.write("height.shape.gii", sphere.mesh.vertices[:, 2], sphere)
    """
    target = Path(path)
    if isinstance(what, Surface):
        if not len(what.mesh.faces):
            raise ValueError(f"surface has {len(what.mesh.vertices)} vertices and 0 faces, at least one face is needed")
        scalars = what.scalars if target.suffix.lower() in WITH_MAPS else {}
        write_mesh(target, what.mesh, scalars, what.frame, what.hemisphere)
        return
    side = surface.hemisphere if surface is not None else ""
    table = getattr(what, "label_map", None)
    if target.name.endswith(LABEL_SUFFIXES) and table is not None:
        write_labels(target, table.keys, list(table.names.values()), side)
        return
    if hasattr(what, "vectors") and target.suffix.lower() == ".npz":
        arrays = {name: getattr(what, name) for name in ("values", "vectors", "residuals") if hasattr(what, name)}
        with replacing(target) as temporary:
            np.savez_compressed(temporary, **arrays)
        return
    maps = maps_of(what)
    if target.suffix.lower() in (".ply", ".vtk", ".vtp"):
        if surface is None:
            raise ValueError(
                f"{target} holds a surface beside its maps: give the surface, or choose .shape.gii, .npz, .csv"
            )
        write_mesh(target, surface.mesh, maps)
        return
    write_maps(target, maps, side)


def maps_of(what: Any) -> dict[str, Floats]:
    """Return the maps (n,) or (n, c) that a result consists of, by name.

    Raises
    ------
    ValueError
        If it has none.
    """
    if isinstance(what, Mapping):
        return {str(name): _written_map(values, f"map {str(name)!r}") for name, values in what.items()}
    if hasattr(what, "vectors"):
        return {f"mode {k}": np.ascontiguousarray(column) for k, column in enumerate(what.vectors.T)}
    array = _written_map(getattr(what, "values", what), f"{type(what).__name__} given as a map")
    return {what.name if isinstance(what, DenoisedMap) else "map": array}


def _written_map(given: Any, what: str) -> Floats:
    array = map_array(given, what)
    if array.ndim not in (1, 2):
        raise ValueError(
            f"{what} has shape {array.shape}, one row a vertex is needed; a surface is written as sx.Surface(mesh)"
        )
    return array


def check_target(path: PathLike, labels: bool = False) -> None:
    """Refuse a file that no map on a surface can be written to, before anything is computed.

    Parameters
    ----------
    path : path
    labels : bool
        Whether formats of labels are among those that are known.

    Raises
    ------
    ValueError
        If the format is unknown, the folder is missing, or it cannot be written to.
    """
    target = Path(path)
    if target.suffix.lower() in WITH_MAPS or (labels and target.name.endswith(LABEL_SUFFIXES)):
        check_writable(target)
    else:
        check_map_target(target)
