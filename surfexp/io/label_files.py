"""Labels of vertices as files that other tools open: GIFTI labels (.label.gii) and FreeSurfer annotations (.annot)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.parsers.expat import ExpatError

import numpy as np
from numpy.typing import NDArray

from surfexp.arrays import Integers


def label_colors(count: int) -> NDArray[np.int64]:
    """Return (count, 3) colours from 0 to 255, no two alike below 65,536 labels, since annotations go by colour."""
    k = np.arange(count)
    return np.stack([(97 * k + 128) % 256, (157 * k + k // 256 + 128) % 256, (211 * k + 128) % 256], axis=1)


def write_labels(path: Path | str, labels: Integers, names: Sequence[str]) -> None:
    """Write labels as .label.gii (or .gii) or .annot, by the file's name, with a colour for each.

    Parameters
    ----------
    labels : (n,) int64
        From 0 to the number of names less 1; by use 0 is "unknown".
    names : sequence of str
        One for each label.

    Raises
    ------
    ValueError
        If a label has no name, names repeat, or the format is another.
    """
    path, labels = Path(path), np.asarray(labels, dtype=np.int64)
    if len(labels) and (labels.min() < 0 or labels.max() >= len(names)):
        given = f"labels go from {labels.min()} to {labels.max()}"
        raise ValueError(f"{given}, the {len(names)} names are of 0..{len(names) - 1}")
    if len(set(names)) < len(names):
        twice = next(name for name in names if list(names).count(name) > 1)
        raise ValueError(f"the name {twice!r} stands for two labels, each needs its own")
    if path.suffix == ".gii":
        _write_gifti(path, labels, names)
    elif path.suffix == ".annot":
        _write_annotation(path, labels, names)
    else:
        raise ValueError(f"{path} has an unknown format of labels, choose one of .label.gii, .annot")


def read_labels(path: Path | str) -> tuple[Integers, tuple[str, ...]]:
    """Return the labels of a file by `write_labels`, or of another's, and their names; -1 where there is none.

    Labels are renumbered from 0 in the order of the file's table.

    Raises
    ------
    ValueError
        If the file is not there, is of another format or cannot be read.
    """
    import nibabel
    from nibabel.filebasedimages import ImageFileError

    path = Path(path)
    if not path.is_file():
        raise ValueError(f"label file {path} is not there")
    try:
        if path.suffix == ".annot":
            with np.errstate(over="ignore"):
                found, _, entries = nibabel.freesurfer.read_annot(path)
            return np.asarray(found, dtype=np.int64), tuple(entry.decode() for entry in entries)
        image = nibabel.load(path)
        table = image.labeltable.get_labels_as_dict()
        values = np.asarray(image.darrays[0].data, dtype=np.int64)
    except (ExpatError, OSError, ValueError, AttributeError, IndexError, MemoryError, ImageFileError) as error:
        raise ValueError(f"{path} is not a readable file of labels: {error}") from error
    keys = sorted(table)
    places = np.full(max([*keys, int(values.max(initial=0)), 0]) + 1, -1, dtype=np.int64)
    places[keys] = np.arange(len(keys))
    return places[values], tuple(table[key] for key in keys)


def _write_gifti(path: Path, labels: Integers, names: Sequence[str]) -> None:
    import nibabel

    gifti = nibabel.gifti
    table = gifti.GiftiLabelTable()
    for key, (name, color) in enumerate(zip(names, label_colors(len(names)) / 255.0, strict=True)):
        entry = gifti.GiftiLabel(key, *map(float, color), 1.0)
        entry.label = name
        table.labels.append(entry)
    array = gifti.GiftiDataArray(labels.astype(np.int32), "NIFTI_INTENT_LABEL", datatype="NIFTI_TYPE_INT32")
    nibabel.save(gifti.GiftiImage(labeltable=table, darrays=[array]), path)


def _write_annotation(path: Path, labels: Integers, names: Sequence[str]) -> None:
    from nibabel.freesurfer import write_annot

    table = np.column_stack([label_colors(len(names)), np.zeros(len(names), np.int64)]).astype(np.int32)
    write_annot(path, labels.astype(np.int32), table, [name.encode() for name in names], fill_ctab=True)
