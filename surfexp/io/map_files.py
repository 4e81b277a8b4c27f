"""Maps, labels and masks on a surface read from files: the format follows from the file's name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.io import freesurfer
from surfexp.io.cifti import is_cifti, read_cifti_maps
from surfexp.io.declared_sizes import check_declared_sizes
from surfexp.io.entrance import reading
from surfexp.io.gifti import is_gifti, read_gifti_maps
from surfexp.io.label_files import read_label_map
from surfexp.io.listed_vertices import with_last_vertices
from surfexp.io.map_shapes import check_map_shapes
from surfexp.io.medial_wall import named_labels, outside_names
from surfexp.io.npz import read_rows
from surfexp.io.numbers import LARGEST_BYTES, real_array
from surfexp.io.text_tables import read_table
from surfexp.mesh.label_map import LabelMap

TEXT = (".csv", ".txt", ".dat")
VOLUMES = (".mgh", ".mgz")
NIFTI = (".nii", ".nii.gz")
UNNAMED = ("map", "map 1")
SURFACES = (".ply", ".vtk", ".vtp", ".vtu", ".obj", ".off", ".stl")
KNOWN = (
    ".shape.gii, .func.gii, .dscalar.nii, .mgh, .mgz, .nii, .npy, .npz, .csv, .txt, .asc, or a FreeSurfer curvature file "
    "(lh.sulc)"
)
# files of labels with names
LABEL_FILES = (".annot", ".label.gii", ".label.gii.gz", ".dlabel.nii")


def read_maps(path: Path | str, hemisphere: str = "", count: int = 0, columns: int = 1) -> dict[str, Floats]:
    """Return the maps of a file by name, each (n,) or (n, c), NaN where nothing is known.

    GIFTI, CIFTI-2 (one hemisphere), .mgh/.mgz, .npy/.npz, text, FreeSurfer curvature (lh.sulc). A file with one unnamed map
    names it after itself. GIFTI may list the vertices of its rows, and then leave out the last ones of a surface with `count`.
    Of a text `columns` may be known.

    Raises
    ------
    ValueError
        If the file is missing, broken or cut off, or holds something else than real numbers; the message begins with its name.
    """
    path = Path(path)
    with reading(path, "cannot be read as a scalar map"):
        if not path.is_file():
            raise ValueError(f"no such file in {path.parent.absolute()}")
        if not 0 < path.stat().st_size <= LARGEST_BYTES:
            raise ValueError(f"it has {path.stat().st_size} bytes, 1 to {LARGEST_BYTES} are readable")
        check_declared_sizes(path)
        maps = read_table(path, columns) if path.suffix.lower() in TEXT else _read(path, hemisphere, count)
        check_map_shapes(maps)
    if len(maps) == 1 and next(iter(maps)) in UNNAMED:
        return {name_of_map(path): next(iter(maps.values()))}
    return maps


def name_of_map(path: Path | str) -> str:
    """Return the name of a map by its file: lh.thickness.mgz is lh.thickness, faithful.npy is faithful."""
    words = Path(path).name.split(".")
    return ".".join(words[:2]) if words[0] in ("lh", "rh") and len(words) > 1 else words[0]


def _read(path: Path, hemisphere: str, count: int) -> dict[str, Floats]:
    suffix = path.suffix.lower()
    if suffix in (".npy", ".npz"):
        return {name: real_array(array, f"array {name!r}") for name, array in read_rows(path, hemisphere).items()}
    if is_cifti(path):
        return read_cifti_maps(path, hemisphere)
    if is_gifti(path):
        return with_last_vertices(path, read_gifti_maps(path), count)
    if suffix in VOLUMES or path.name.lower().endswith(NIFTI):
        return {"map": freesurfer.read_volume_map(path)}
    if suffix == ".asc":
        return {"map": freesurfer.read_ascii_map(path)}
    with path.open("rb") as stream:
        start = stream.read(3)
    if start == b"\xff\xff\xff":
        return {"map": freesurfer.read_map(path)}
    if freesurfer.is_old_map(path):
        return {"map": freesurfer.read_old_map(path)}
    if suffix in SURFACES:
        raise ValueError("it is a surface: give it first, and a map that it carries by name")
    raise ValueError(f"its format is unknown; known are {KNOWN}")


def read_scalars(path: Path | str, hemisphere: str = "", count: int = 0) -> Floats:
    """Return (n,) or (n, c) values: the one map of a file, or its maps side by side.

    Raises
    ------
    ValueError
        As `read_maps`, or if the maps have different lengths.
    """
    return side_by_side(read_maps(path, hemisphere, count), path)


def side_by_side(maps: dict[str, Floats], path: Path | str) -> Floats:
    """Return (n,) or (n, c) values: the one map of a file, or its maps as columns.

    Raises
    ------
    ValueError
        If the maps have different lengths.
    """
    lengths = {len(values) for values in maps.values()}
    if len(lengths) != 1:
        raise ValueError(f"{path} cannot be read as a scalar map: its arrays have lengths {sorted(lengths)}")
    columns = np.column_stack(list(maps.values()))
    return np.ascontiguousarray(columns[:, 0]) if columns.shape[1] == 1 else columns


def read_named_labels(path: Path | str, hemisphere: str = "", count: int = 0) -> LabelMap:
    """Return the labels of a .label.gii, .annot or .dlabel.nii (its first map) that anybody may have sent.

    Where GIFTI lists the vertices of its rows, the last ones of a surface with `count` may be left out: they have none, -1.

    Raises
    ------
    ValueError
        As `read_label_map`, or if sizes that the file declares cannot be true.
    """
    path = Path(path)
    if path.is_file():
        with reading(path, "is not a readable file of labels"):
            check_declared_sizes(path)
    found = read_label_map(path, hemisphere)
    return replace(found, keys=with_last_vertices(path, {"": found.keys}, count, -1)[""]) if is_gifti(path) else found


def read_mask(path: Path | str, count: int, hemisphere: str = "") -> NDArray[np.bool_]:
    """Return a mask of `count` vertices from a file.

    A FreeSurfer .label lists the vertices inside. Of labels with names (.label.gii, .annot, .dlabel.nii) all but unknown and
    medial wall are inside, or those named behind a colon: `lh.aparc.annot:insula,precentral`, also by number. Of labels whose file
    names none, and of a map, what is neither 0 nor NaN.

    Raises
    ------
    ValueError
        If the file cannot be read, has another length, or a name is unknown.
    """
    text, _, names = str(path).partition(":") if not Path(path).is_file() else (str(path), "", "")
    file = Path(text)
    if file.suffix.lower() == ".label":
        inside = _listed(file, count)
    elif _has_names(file):
        labels = read_named_labels(file, hemisphere, count)
        wanted = [name.strip() for name in names.split(",") if name.strip()]
        inside = np.isin(labels.keys, list(named_labels(labels.keys, labels.names)))
        if wanted:
            inside = np.any([_where(labels, name) for name in wanted], axis=0)
    elif names:
        raise ValueError(
            f"{file} has no named labels, {names!r} can be chosen from .label.gii, .annot and .dlabel.nii only"
        )
    else:
        values = read_scalars(file, hemisphere, count)
        inside = np.isfinite(values) & (values != 0)
    if inside.shape != (count,):
        raise ValueError(f"{file} has shape {inside.shape} as a mask, the surface has {count} vertices")
    return inside


def _where(labels: LabelMap, name: str) -> NDArray[np.bool_]:
    """Which vertices have a label, given by its name or its number."""
    if name not in labels.names.values():
        known = named_labels(labels.keys, labels.names)
        if name.isdigit() and int(name) in labels.keys:
            return np.asarray(labels.keys == int(name))
        if known and not set(known) & set(labels.names):
            raise ValueError(
                f"no label is named {name!r}, labels have numbers only: choose from {', '.join(known.values())}"
            )
    return labels.where(name)


def mask_notes(path: Path | str, hemisphere: str = "") -> tuple[str, ...]:
    """Say which labels of a file were taken for the medial wall, where nobody named those inside.

    Raises
    ------
    ValueError
        As `read_mask`.
    """
    file = Path(path)
    if not file.is_file() or not _has_names(file):
        return ()
    labels = read_named_labels(file, hemisphere)
    used = set(np.unique(labels.keys).tolist())
    names = outside_names(name for key, name in labels.names.items() if key in used)
    known = named_labels(labels.keys, labels.names)
    unnamed = int((~np.isin(labels.keys, [*labels.names, *known])).sum()) if labels.names else 0
    said = [f"Outside the mask are the labels {', '.join(map(repr, names))} of {file.name}."] if names else []
    if unnamed:
        said.append(f"Outside the mask are {unnamed} vertices of {file.name} whose label has no name.")
    if labels.names and not set(known) & set(labels.names):
        said.append(f"{file.name} names no label: inside are its labels {', '.join(known.values()) or 'none'}.")
    return tuple(said)


def _has_names(file: Path) -> bool:
    return file.name.lower().endswith(LABEL_FILES)


def _listed(file: Path, count: int) -> NDArray[np.bool_]:
    with reading(file, "cannot be read as a label"):
        numbers = freesurfer.read_vertex_list(file)
    # FreeSurfer writes -1 for a point that it could not assign to a vertex
    numbers = numbers[numbers != -1]
    if len(numbers) and not 0 <= numbers.min() <= numbers.max() < count:
        worst = numbers.min() if numbers.min() < 0 else numbers.max()
        raise ValueError(f"{file} names vertex {worst}, the surface has 0..{count - 1}")
    inside = np.zeros(count, dtype=bool)
    inside[numbers] = True
    return inside
