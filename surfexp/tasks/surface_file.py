"""One surface with its maps, labels and mask, from files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.io.gifti import is_gifti
from surfexp.io.hemisphere import common_hemisphere, hemisphere_of_file
from surfexp.io.label_colours import passed_over, read_coloured_labels
from surfexp.io.map_files import mask_notes, name_of_map, read_maps, read_mask
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.mesh_file import MeshFile
from surfexp.io.reading import READERS, read_mesh_file
from surfexp.mesh.given_arrays import mask_array
from surfexp.mesh.given_numbers import one_of
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.repaired_surface import repaired
from surfexp.tasks.soundness import sound_part

PathLike = str | Path


def read_surface(
    path: PathLike, *, maps: Any, labels: Any, mask: Any, unit: str, hemisphere: str, repair: bool
) -> Surface:
    """Read one surface; arguments as those of `surfexp.read`.

    Raises
    ------
    ValueError
        As `surfexp.read`.
    """
    if hemisphere != "":
        one_of(hemisphere, "hemisphere", HEMISPHERES)
    if Path(path).is_dir():
        raise ValueError(f"{path} is a folder: give one file of it{_surface_in(Path(path))}")
    file_read = read_mesh_file(Path(path))
    vertices, faces = file_read.vertices, file_read.faces
    scalars, left_out = maps_of_file(file_read, path)
    if isinstance(mask, Mapping):
        raise ValueError("mask is a pair, path is one surface: give left= and right=, or one mask")
    count = len(vertices)
    map_files, label_files = by_name(maps, "maps"), by_name(labels, "labels")
    files: list[tuple[str, PathLike]] = [("surface", path)]
    files += [(f"map {name!r}", file) for name, file in map_files.items()]
    files += [(f"labels {name!r}", file) for name, file in label_files.items()]
    files += [("mask", str(mask).partition(":")[0])] if isinstance(mask, str | Path) else []
    facts = file_read.facts
    side = hemisphere or common_hemisphere(files)
    if facts.right is not None:
        raise ValueError(f"{path} holds both hemispheres, one file or hemisphere= says {side}: give what is of both")
    notes = (*file_read.notes, *left_out, *_overridden(hemisphere, path))
    for name, file in map_files.items():
        scalars |= _named(name, read_maps(file, side, count), count, file)
    tables: dict[str, LabelMap] = {name: read_coloured_labels(file, side, count) for name, file in label_files.items()}
    tables = {**facts.labels, **tables}
    notes += tuple(note for file in label_files.values() for note in passed_over(file))
    for name, table in tables.items():
        if len(table.keys) != count:
            raise ValueError(f"labels {name!r} have {len(table.keys)} entries, {path} has {count} vertices")
    if isinstance(mask, str | Path):
        notes = (*notes, *mask_notes(mask, side))
        mask = read_mask(mask, count, side)
    inside = facts.mask if mask is None else mask_array(mask, count)
    surface = Surface(
        TriangleMesh(vertices, faces),
        Path(path).stem,
        unit or facts.unit or _unit_of(file_read.frame),
        scalars,
        mask=inside,
        hemisphere=side,
        labels=tables,
        notes=notes,
        frame=file_read.frame,
    )
    return sound_or_repaired(surface, path, repair)


def sound_or_repaired(surface: Surface, path: PathLike, repair: bool) -> Surface:
    """Return the part of a surface inside its mask if it is sound, and else the repaired one where that is asked for.

    Raises
    ------
    ValueError
        If it has a defect that is not to be repaired, or cannot be.
    """
    try:
        return sound_part(surface, str(path), repair="")
    except ValueError:
        if not repair:
            raise
    return sound_part(repaired(surface), str(path), repair="")


def maps_of_file(file: MeshFile, path: PathLike) -> tuple[dict[str, Floats], tuple[str, ...]]:
    """Return the maps beside a geometry, a channel each, and say which are left out because a value is infinite."""
    maps = scalar_channels(file.scalars)
    counts = {name: int(np.isinf(values).sum()) for name, values in maps.items()}
    left_out = tuple(
        f"{path}: map {name!r} has {count} infinite values of {len(maps[name])}: it is left out; NaN stands for what is not known."
        for name, count in counts.items()
        if count
    )
    return {name: values for name, values in maps.items() if not counts[name]}, left_out


def _surface_in(folder: Path) -> str:
    """An example of a surface in a folder, of a subject of FreeSurfer's or of meshes; nothing where there is none."""
    names = [f"{part}lh.{sheet}" for part in ("", "surf/") for sheet in ("white", "pial")]
    meshes = sorted(file.name for file in folder.iterdir() if file.suffix.lower() in READERS or is_gifti(file))
    found = next((name for name in [*names, *meshes] if (folder / name).is_file()), None)
    return "" if found is None else f", as {folder / found}"


def by_name(given: Any, what: str) -> dict[str, PathLike]:
    """Return files by name: as given, or each by the name of its file.

    Raises
    ------
    ValueError
        If two files have one name, or something is no path.
    """
    if given is None:
        return {}
    files = given if isinstance(given, Mapping) else [given] if isinstance(given, str | Path) else given
    wrong = None if isinstance(files, Iterable) else files
    for file in files.values() if isinstance(files, Mapping) else files if wrong is None else ():
        wrong = file if wrong is None and not isinstance(file, str | Path) else wrong
    if wrong is not None:
        raise ValueError(f"{what} has a {type(wrong).__name__}: give a path, a list of paths, or paths by name")
    if isinstance(files, Mapping):
        return {str(name): file for name, file in files.items()}
    names = [name_of_map(file) for file in files]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"two files of {what} are called {twice!r}: give each a name, as {{'a': path, 'b': path}}")
    return dict(zip(names, files, strict=True))


def _overridden(hemisphere: str, path: PathLike) -> tuple[str, ...]:
    found = hemisphere_of_file(path) if hemisphere else ""
    return (f"{path} says {found}; it is taken as {hemisphere}, as given.",) if found not in ("", hemisphere) else ()


def _named(name: str, maps: dict[str, Floats], count: int, file: PathLike) -> dict[str, Floats]:
    for values in maps.values():
        if len(values) != count:
            raise ValueError(f"map {file} has {len(values)} values, the surface has {count} vertices")
    named = {name: next(iter(maps.values()))} if len(maps) == 1 else {f"{name} {key}": v for key, v in maps.items()}
    return scalar_channels(named)


def _unit_of(frame: SpatialFrame) -> str:
    """The unit that FreeSurfer and GIFTI prescribe where a file names a scanner's space or a structure of the brain."""
    return "mm" if frame.volume or frame.metadata.get("AnatomicalStructurePrimary") else ""
