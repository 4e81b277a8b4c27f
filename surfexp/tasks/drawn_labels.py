"""Labels as pictures show them: of one surface or by hemisphere, by name, as a file, a table, numbers or texts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.figures.labelling import Labelling, labelling
from surfexp.io.hemisphere import check_same_side
from surfexp.io.label_colours import read_coloured_labels
from surfexp.io.map_files import LABEL_FILES
from surfexp.mesh.both_hemispheres import vertices_of
from surfexp.mesh.coloured_labels import Colour, ColouredLabels
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.tasks.given_labels import are_labels, as_labels, labels_on
from surfexp.tasks.given_map import as_map


def known_labels(owner: Surface, given: Any) -> Any:
    """Return labels that are given as texts, floats or by side as one table; a name, a result and whole numbers stay."""
    if given is None or isinstance(given, str | Path | LabelMap) or hasattr(given, "label_map"):
        return given
    if not isinstance(given, Mapping) and np.asarray(given).dtype.kind in "biu":
        return given
    return labels_on(owner, given)


def maps_apart(owners: Sequence[Surface], given: Sequence[Any]) -> list[Any]:
    """Return a map, or labels, of each surface for each of its hemispheres."""
    return [one for owner, values in zip(owners, given, strict=True) for one in _map_apart(owner, values)]


def _map_apart(owner: Surface, given: Any) -> list[Any]:
    """Return a map, or labels, of a surface for each of its hemispheres; a name stays."""
    if owner.right is None:
        return [given]
    if given is None or (isinstance(given, str) and (given in owner.scalars or given in owner.labels)):
        return [given, given]
    rows = [vertices_of(owner, side) for side in HEMISPHERES]
    table = labels_on(owner, given) if are_labels(given) else getattr(given, "label_map", given)
    if isinstance(table, LabelMap):
        keys = as_labels(owner, table.keys)
        return [replace(table, keys=keys[own]) for own in rows]
    array = np.asarray(getattr(given, "values", given))
    if array.dtype.kind in "biu" and array.ndim == 1:
        array = as_labels(owner, array)
        return [array[own] for own in rows]
    return [as_map(owner, getattr(given, "values", given))[own] for own in rows]


def _table(owner: Surface, given: Any) -> Any:
    """Return the table of labels that is given by name, as a file or in a result; anything else as it is."""
    given = labels_on(owner, given) if are_labels(given) else getattr(given, "label_map", given)
    if isinstance(given, str) and given in owner.labels and given not in owner.scalars:
        given = owner.labels[given]
    if isinstance(given, str | Path) and str(given).lower().endswith(LABEL_FILES) and Path(given).is_file():
        check_same_side("labels", given, owner.hemisphere)
        given = read_coloured_labels(given, owner.hemisphere)
    return given


def own_label_colors(owner: Surface, given: Any) -> dict[str, Colour]:
    """Return the colours that labels have of their own, as those of an atlas have, by name."""
    table = _table(owner, given)
    return table.by_name if isinstance(table, ColouredLabels) else {}


def drawn_labels(owner: Surface, given: Any) -> Labelling | None:
    """Return labels where they are given: a `LabelMap`, a result that has one, a name, or whole numbers as integers."""
    given = _table(owner, given)
    if isinstance(given, LabelMap):
        found = labelling(as_labels(owner, given.keys), given.names)
        own = given.by_name if isinstance(given, ColouredLabels) else {}
        colors = [own.get(name, made) for name, made in zip(found.names, found.colors, strict=True)]
        return replace(found, colors=np.array(colors, dtype=np.float64).reshape(-1, 3))
    if isinstance(given, str | Path) or given is None or hasattr(given, "values"):
        return None
    array = np.asarray(given)
    if array.dtype == np.bool_ and array.ndim == 1:
        return labelling(as_labels(owner, array.astype(np.int64)), {0: "outside", 1: "inside"})
    if array.dtype.kind in "iu" and array.ndim == 1:
        return labelling(as_labels(owner, array.astype(np.int64)))
    return None
