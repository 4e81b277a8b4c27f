"""Labels of vertices as flat colours: one colour a label, and a border where two meet."""

from __future__ import annotations

import colorsys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.figures.lines import Lines
from surfexp.figures.typography import INK
from surfexp.io.medial_wall import named_labels
from surfexp.mesh.triangle_mesh import TriangleMesh

# Okabe and Ito (2008) without black and yellow; for more labels hues a golden ratio apart, at three lightnesses
COLORS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00")
GOLDEN, LIGHTNESSES = 0.618033988749895, (0.55, 0.72, 0.40)
BORDER_WIDTH, BORDER_CASING = 1.4, 0.7


@dataclass(frozen=True, eq=False)
class Labelling:
    """Which label each vertex has, and how labels are called and coloured.

    Parameters
    ----------
    index : (n,) int64
        Into names and colours; -1 where there is no label, which is drawn grey.
    names : tuple of k str
    colors : (k, 3) float64
        Red, green and blue in 0..1.
    """

    index: Integers
    names: tuple[str, ...]
    colors: Floats

    @property
    def values(self) -> Floats:
        """(n,) the index as numbers, NaN where there is no label."""
        return np.where(self.index < 0, np.nan, self.index.astype(np.float64))


def labelling(keys: Integers, names: Mapping[int, str] | None = None) -> Labelling:
    """Return the labels that occur, in the order of their keys.

    Parameters
    ----------
    keys : (n,) int64
    names : dict of int to str, optional
        What each key stands for; one that it lacks, and one named "unknown", "???" or as the medial wall, means no label. Where
        it has no other names each key but 0, and without names each key from 0 on, is a label named by its number.

    Returns
    -------
    Labelling

    Examples
    --------
    >>> import numpy as np
    >>> found = labelling(np.array([7, -1, 0, 7]))
    >>> found.names, found.index.tolist()
    (('0', '7'), [1, -1, 0, 1])
    """
    present = [int(key) for key in np.unique(keys)]
    if names is None:
        known = {key: str(key) for key in present if key >= 0}
    else:
        named = named_labels(keys, names)
        known = {key: named[key] for key in present if key in named}
    place = {key: number for number, key in enumerate(known)}
    unique, inverse = np.unique(keys, return_inverse=True)
    index = np.array([place.get(int(key), -1) for key in unique], dtype=np.int64)[inverse]
    return Labelling(index, tuple(known.values()), label_colors(len(known)))


def label_colors(count: int) -> Floats:
    """Return (count, 3) colours that differ, the first six in every common colour blindness."""
    first = [tuple(int(color[k : k + 2], 16) / 255.0 for k in (1, 3, 5)) for color in COLORS[:count]]
    more = [
        colorsys.hls_to_rgb(k * GOLDEN % 1.0, LIGHTNESSES[k % len(LIGHTNESSES)], 0.65)
        for k in range(count - len(COLORS))
    ]
    return np.array([*first, *more], dtype=np.float64).reshape(-1, 3)


def border_lines(mesh: TriangleMesh, index: Integers) -> Lines:
    """Return the lines between vertices of different labels.

    A label fills of each face the points that are nearest to its vertices in barycentric coordinates: the border runs
    from the middle of each edge whose ends differ to the middle of the face.

    Parameters
    ----------
    mesh : TriangleMesh
    index : (n,) int64

    Returns
    -------
    Lines
    """
    start, end = mesh.edges.T
    cut = index[start] != index[end]
    face, side = np.nonzero(cut[mesh.face_edges])
    edges, middles = np.unique(mesh.face_edges[face, side], return_inverse=True)
    faces, centres = np.unique(face, return_inverse=True)
    points = np.concatenate(
        [mesh.vertices[mesh.edges[edges]].mean(axis=1), mesh.vertices[mesh.faces[faces]].mean(axis=1)]
    )
    segments = np.stack([middles, len(edges) + centres], axis=1).astype(np.int64)
    return Lines(points, segments, INK, BORDER_WIDTH, casing=BORDER_CASING, faces=face.astype(np.int64))


def legend_of(labellings: Sequence[Labelling]) -> list[tuple[str, Any]]:
    """Return name and colour of each label of several maps, once."""
    found = {
        (name, tuple(color)): None for one in labellings for name, color in zip(one.names, one.colors, strict=True)
    }
    return list(found)
