"""Labels of vertices as files: GIFTI labels (.label.gii), FreeSurfer annotations (.annot) and label lists (.label)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers
from surfexp.io.cifti import is_cifti, read_cifti_labels
from surfexp.io.foreign import parsing
from surfexp.io.freesurfer_sizes import entries_of_annotation
from surfexp.io.gifti import is_gifti, read_gifti_labels, write_gifti_labels
from surfexp.io.hemisphere import check_named_side
from surfexp.io.map_names import check_label_names
from surfexp.io.replacing import replacing
from surfexp.mesh.label_map import LabelMap


def label_colors(count: int) -> NDArray[np.int64]:
    """Return (count, 3) colours from 0 to 255, no two alike below 65,536 labels, since annotations go by colour."""
    k = np.arange(count)
    return np.stack([(97 * k + 128) % 256, (157 * k + k // 256 + 128) % 256, (211 * k + 128) % 256], axis=1)


def write_labels(path: Path | str, labels: Integers, names: Sequence[str], hemisphere: str = "") -> None:
    """Write labels from 0 to the number of names less 1 as `write_label_map` does.

    Raises
    ------
    ValueError
        As `write_label_map`, or if a label has no name.
    """
    labels = np.asarray(labels, dtype=np.int64)
    if len(labels) and (labels.min() < 0 or labels.max() >= len(names)):
        given = f"labels go from {labels.min()} to {labels.max()}"
        raise ValueError(f"{given}, the {len(names)} names are of 0..{len(names) - 1}")
    write_label_map(path, LabelMap(labels, dict(enumerate(names))), hemisphere)


def write_label_map(path: Path | str, table: LabelMap, hemisphere: str = "") -> None:
    """Write labels as .label.gii (or .gii) or .annot, by the file's name, with a colour for each.

    Parameters
    ----------
    table : LabelMap
        By use 0 is "unknown". An annotation numbers labels from 0 in the order of the names.
    hemisphere : {"", "left", "right"}
        GIFTI says it; an annotation says it by its name alone.

    Raises
    ------
    ValueError
        If an annotation has a label without a name, a name cannot be stored, the format is another, or the file is named as
        the other hemisphere.
    """
    path = Path(path)
    if path.suffix not in (".gii", ".annot"):
        raise ValueError(f"{path} has an unknown format of labels, choose one of .label.gii, .annot")
    check_named_side(path, hemisphere)
    check_label_names(table.names.values())
    largest = int(np.abs([*table.names, *(table.keys.min(), table.keys.max())]).max()) if len(table.keys) else 0
    if largest > np.iinfo(np.int32).max:
        raise ValueError(f"label {largest} is beyond {np.iinfo(np.int32).max}, the largest that a file holds: renumber")
    with replacing(path) as temporary:
        if path.suffix == ".gii":
            write_gifti_labels(temporary, table.keys, dict(table.names), label_colors(len(table.names)), hemisphere)
        else:
            _write_annotation(temporary, table)


def read_label_map(path: Path | str, hemisphere: str = "") -> LabelMap:
    """Return the labels of a .label.gii, .annot or .dlabel.nii (its first map) as they stand in the file.

    Raises
    ------
    ValueError
        If the file is not there, is of another format or cannot be read; the message begins with its name.
    """
    path = Path(path)
    if not path.is_file():
        raise ValueError(f"label file {path} is not there")
    try:
        if path.suffix == ".annot":
            return _read_annotation(path)
        if is_cifti(path):
            return next(iter(read_cifti_labels(path, hemisphere).values()))
        if is_gifti(path):
            return read_gifti_labels(path)
    except (OSError, ValueError) as error:
        raise ValueError(f"{path} is not a readable file of labels: {error}") from error
    raise ValueError(f"{path} is not a readable file of labels: choose one of .label.gii, .annot, .dlabel.nii")


def read_labels(path: Path | str) -> tuple[Integers, tuple[str, ...]]:
    """Return labels renumbered from 0 in the order of the file's table, -1 where there is none, and their names.

    Raises
    ------
    ValueError
        As `read_label_map`.
    """
    found = read_label_map(path)
    keys = sorted(found.names)
    if not keys:
        return np.full(len(found.keys), -1, dtype=np.int64), ()
    nearest = np.clip(np.searchsorted(keys, found.keys), 0, len(keys) - 1)
    known = np.asarray(keys)[nearest] == found.keys
    return np.where(known, nearest, -1), tuple(found.names[key] for key in keys)


def _read_annotation(path: Path) -> LabelMap:
    """Labels by the file's own numbers of vertices and colours; a colour that is in no entry of the table is -1."""
    import nibabel

    with parsing("annotation"), np.errstate(over="ignore"):
        _, table, entries = nibabel.freesurfer.read_annot(path, orig_ids=True)
    data = path.read_bytes()
    pairs = np.frombuffer(data, ">i4", 2 * int.from_bytes(data[:4], "big"), 4).reshape(-1, 2).astype(np.int64)
    count = len(pairs)
    if not np.array_equal(np.sort(pairs[:, 0]), np.arange(count)):
        raise ValueError(f"its {count} entries do not name the vertices 0..{count - 1} once each")
    colors = np.zeros(count, dtype=np.int64)
    colors[pairs[:, 0]] = pairs[:, 1]
    # nibabel keeps rows of the table by their number, and names in the order of the file
    numbers = entries_of_annotation(data)
    names = {key: entry.decode("utf-8", "replace") for key, entry in zip(numbers, entries, strict=True)}
    rows = np.array(sorted(names), dtype=np.int64)
    values = table[rows, 4].astype(np.int64)
    order = np.argsort(values, kind="stable")
    place = np.minimum(np.searchsorted(values[order], colors), max(len(order) - 1, 0))
    keys = np.where(values[order][place] == colors, rows[order][place], -1) if len(order) else np.full(count, -1)
    return LabelMap(keys, names)


def _write_annotation(path: Path, table: LabelMap) -> None:
    """Write labels by their place in the table of names; -1, which no name may have, is none."""
    from nibabel.freesurfer import write_annot

    count, place = len(table.names), {key: number for number, key in enumerate(table.names)}
    used = np.unique(table.keys).tolist()
    nameless = next((key for key in used if key not in place and key != -1), None)
    if nameless is not None or not count:
        raise ValueError(f"label {nameless if count else used[0]} has no name, an annotation holds named ones: name it")
    places = np.array([place.get(key, -1) for key in used], dtype=np.int32)[np.searchsorted(used, table.keys)]
    colors = np.column_stack([label_colors(count), np.zeros(count, np.int64)]).astype(np.int32)
    write_annot(path, places, colors, [name.encode() for name in table.names.values()], fill_ctab=True)
