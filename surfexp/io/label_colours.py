"""Labels with the colours that their file gives them, as atlases are known by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from surfexp.io.cifti import is_cifti
from surfexp.io.foreign import parsing
from surfexp.io.label_files import label_colors
from surfexp.io.map_files import read_named_labels
from surfexp.mesh.label_map import LabelMap

# red, green and blue in 0..1
Colour = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class ColouredLabels(LabelMap):
    """One label a vertex, with a colour for labels that have one.

    Parameters
    ----------
    keys : (n,) or (n, 1) int64
    names : dict of int to str
        Both as in `LabelMap`.
    colors : dict of int to (float, float, float)
        Red, green and blue in 0..1 by label; of one that it lacks no colour is known.

    Examples
    --------
    >>> import numpy as np
    >>> table = ColouredLabels(np.array([4, 4, 7]), {4: "insula", 7: "cuneus"}, {4: (1.0, 0.75, 0.125)})
    >>> table.by_name
    {'insula': (1.0, 0.75, 0.125)}
    """

    colors: Mapping[int, Colour] = field(default_factory=dict)

    @property
    def by_name(self) -> dict[str, Colour]:
        """The colours by the names of their labels."""
        return {self.names[key]: color for key, color in self.colors.items() if key in self.names}


def read_coloured_labels(path: Path | str, hemisphere: str = "") -> ColouredLabels:
    """Return the labels of a .label.gii, .annot or .dlabel.nii (its first map) with the colours of its table.

    Parameters
    ----------
    path : path
    hemisphere : {"", "left", "right"}
        Of a .dlabel.nii.

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
    found = read_named_labels(path, hemisphere)
    colors = _table(Path(path))
    made = dict(zip(found.names, map(tuple, (label_colors(len(found.names)) / 255.0).tolist()), strict=True))
    apart = any(
        not np.allclose(color, made[key], atol=2.0 / 255.0) for key, color in colors.items() if key in found.names
    )
    says = apart and (len({*colors.values()}) > 1 or len(found.names) == 1)
    return ColouredLabels(found.keys, found.names, colors if says else {})


def coloured_as(table: LabelMap, *files: LabelMap) -> LabelMap:
    """Return labels in the colours that other labels have under the same names; of two the first counts.

    Parameters
    ----------
    table : LabelMap
    *files : LabelMap

    Returns
    -------
    LabelMap
        With `colors`, where one of the others has them.
    """
    known: dict[str, Colour] = {}
    for file in reversed(files):
        known |= file.by_name if isinstance(file, ColouredLabels) else {}
    colors = {key: known[name] for key, name in table.names.items() if name in known}
    return ColouredLabels(table.keys, table.names, colors) if colors else table


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
            table = nibabel.load(path).labeltable.labels
            rows = {int(entry.key): (entry.red, entry.green, entry.blue, entry.alpha) for entry in table}
    known = {key: rgba for key, rgba in rows.items() if None not in rgba and np.isfinite(rgba).all() and rgba[3] > 0}
    # some programs write bytes where the formats ask for shares
    whole = 255.0 if any(max(rgba[:3]) > 1.0 for rgba in known.values()) else 1.0
    return {key: _colour([channel / whole for channel in rgba[:3]]) for key, rgba in known.items()}


def _colour(channels: list[float]) -> Colour:
    red, green, blue = (min(max(float(channel), 0.0), 1.0) for channel in channels)
    return red, green, blue
