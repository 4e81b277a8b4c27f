"""Labels with the colours that their file gives them, read and written."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.io.cifti import is_cifti
from surfexp.io.foreign import parsing
from surfexp.io.gifti import LABELS, image_code, is_gifti, load_gifti
from surfexp.io.label_files import label_colors, write_label_map
from surfexp.io.map_files import read_named_labels
from surfexp.io.map_names import told_apart
from surfexp.io.replacing import replacing
from surfexp.mesh.coloured_labels import Colour, ColouredLabels
from surfexp.mesh.label_map import LabelMap


def read_coloured_labels(path: Path | str, hemisphere: str = "", count: int = 0) -> ColouredLabels:
    """Return the labels of a .label.gii, .annot or .dlabel.nii (its first map) with the colours of its table.

    Parameters
    ----------
    path : path
    hemisphere : {"", "left", "right"}
        Of a .dlabel.nii.
    count : int
        Vertices of the surface, of which GIFTI may leave out the last ones.

    Returns
    -------
    ColouredLabels
        Without colours where the table says nothing by them: where all are alike, or those that this package writes for
        labels without colours.

    Raises
    ------
    ValueError
        As `read_named_labels`.
    """
    found = read_named_labels(path, hemisphere, count)
    colors = _table(Path(path))
    made = dict(zip(found.names, map(tuple, (label_colors(len(found.names)) / 255.0).tolist()), strict=True))
    apart = any(
        not np.allclose(color, made[key], atol=2.0 / 255.0) for key, color in colors.items() if key in found.names
    )
    says = apart and (len({*colors.values()}) > 1 or len(found.names) == 1)
    return ColouredLabels(found.keys, found.names, colors if says else {})


def passed_over(path: Path | str) -> tuple[str, ...]:
    """Say where a file that has been read holds other labels behind the first, which alone are taken."""
    import nibabel

    file, names = Path(path), []
    if is_cifti(file):
        names = told_apart(nibabel.load(file).header.get_axis(0).name)
    elif is_gifti(file):
        arrays = [array for array in load_gifti(file).darrays if array.intent == image_code(LABELS)]
        names = told_apart(array.metadata.get("Name", "") for array in arrays)
    if len(names) < 2:
        return ()
    return (f"{file.name} has {len(names)} maps of labels, {', '.join(map(repr, names))}: the first is taken.",)


def write_coloured_labels(path: Path | str, table: LabelMap, hemisphere: str = "") -> None:
    """Write labels as `write_label_map` does, in their own colours where they have some.

    An annotation knows a label by its colour: black, and a colour of another label, are left out of it.

    Parameters
    ----------
    path : path
    table : LabelMap
    hemisphere : {"", "left", "right"}

    Raises
    ------
    ValueError
        As `write_label_map`.
    """
    write_label_map(path, table, hemisphere)
    if isinstance(table, ColouredLabels) and table.colors:
        with replacing(Path(path)) as temporary:
            _recolour(Path(path), temporary, table)


def _table(path: Path) -> dict[int, Colour]:
    """Colours of a file that has been read; none for what is transparent in GIFTI and CIFTI, as "???" is."""
    import nibabel

    with parsing("file of labels"):
        if path.suffix == ".annot":
            entries = nibabel.freesurfer.read_annot(path)[1][:, :3] / 255.0
            return {key: _colour(row) for key, row in enumerate(entries.tolist())}
        if is_cifti(path):
            rows = {int(key): rgba for key, (_, rgba) in nibabel.load(path).header.get_axis(0).label[0].items()}
        else:
            table = load_gifti(path).labeltable.labels
            rows = {int(entry.key): (entry.red, entry.green, entry.blue, entry.alpha) for entry in table}
    known = {key: rgba for key, rgba in rows.items() if None not in rgba and np.isfinite(rgba).all() and rgba[3] > 0}
    # some programs write bytes where the formats ask for shares
    whole = 255.0 if any(max(rgba[:3]) > 1.0 for rgba in known.values()) else 1.0
    return {key: _colour([channel / whole for channel in rgba[:3]]) for key, rgba in known.items()}


def _recolour(written: Path, target: Path, table: ColouredLabels) -> None:
    """Write a file of labels once more, in the colours of a table."""
    import nibabel

    if written.suffix != ".annot":
        image = nibabel.load(written)
        for entry in image.labeltable.labels:
            if entry.key in table.colors:
                entry.red, entry.green, entry.blue = table.colors[entry.key]
        nibabel.save(image, target)
        return
    places, rows, names = nibabel.freesurfer.read_annot(written)
    used = {tuple(row) for row in rows[:, :3].tolist()} | {(0, 0, 0)}
    for row, key in zip(rows, table.names, strict=True):
        color = tuple(round(255.0 * channel) for channel in table.colors.get(key, (0.0, 0.0, 0.0)))
        if color not in used:
            used = (used - {tuple(row[:3].tolist())}) | {color}
            row[:3] = color
    nibabel.freesurfer.write_annot(target, places, rows[:, :4], names, fill_ctab=True)


def _colour(channels: list[float]) -> Colour:
    red, green, blue = (min(max(float(channel), 0.0), 1.0) for channel in channels)
    return red, green, blue
