"""The line of a sulcus: the Reeb graph of the first eigenfunction of its region, and its length by several estimators."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.polyline import trunk
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton_length import skeleton_lengths
from surfexp.spectrum.eigensolver import eigenpairs

from .sulcal_lengths import region_mesh

LEVELS = 50
LINE_ESTIMATORS = {
    "published line": "polyline_length",
    "line with ends": "length_with_extrema",
    "geodesic": "geodesic_length",
    "mean distance": "mean_distance_length",
}


@dataclass(frozen=True, eq=False)
class SulcalLine:
    """The line of one region.

    Parameters
    ----------
    points : (p, 3) float64
        From one end of the region to the other, in the space of the surface.
    lengths : dict of str to float
        By estimator, in the unit of the surface: "published line" through the middles of uniform level lines (section 5.2),
        which stops short of both ends; "line with ends" with them; "geodesic" between the ends inside the region; and
        "mean distance", the mean widths between level lines, summed.
    chain : bool
        Whether the graph is one path, so that nothing was cut off.
    """

    points: Floats
    lengths: dict[str, float]
    chain: bool


def sulcal_line(mesh: TriangleMesh, inside: NDArray[np.bool_], levels: int = LEVELS) -> SulcalLine:
    """Return the line of a sulcal region by the Reeb graph of its first eigenfunction (free boundary), 6.4.2.

    Parameters
    ----------
    mesh : TriangleMesh
    inside : (n,) bool
        The region; its largest connected piece of whole faces is taken.
    levels : int
        Uniform levels of the function.

    Raises
    ------
    ValueError
        If the region has no whole face, or a single one.
    """
    part = region_mesh(mesh, inside)[0]
    if len(part.vertices) < 4:
        raise ValueError(f"the region has {len(part.vertices)} vertices, a line needs at least 4")
    elements = surface_elements(part)
    first = eigenpairs(elements.stiffness, elements.mass, 2, method="dense").vectors[:, 1]
    graph = reeb_graph(part, first, choose_levels(part, first, levels, "uniform"), "sulcus")
    found = skeleton_lengths(part, first, graph)
    lengths = {name: found[key] for name, key in LINE_ESTIMATORS.items()}
    return SulcalLine(graph.positions[trunk(graph)], lengths, graph.is_chain)
