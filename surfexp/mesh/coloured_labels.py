"""Labels of vertices with the colours that atlases are known by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

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
