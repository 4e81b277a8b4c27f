"""The Reeb graph as section 5.2 prints it: contours of neighbouring levels joined pairwise, nothing beyond the outermost."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.interlevel_components import slab_components
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.skeleton import arc_components


def published_loops(mesh: TriangleMesh, values: Floats, levels: Floats) -> int:
    """Independent loops of the graph by the published rule.

    A contour of one level and a contour of the next are joined if they bound one component of the slab between. A slab in
    which p contours become q gives p q arcs, so a saddle of two and two makes a loop; and a handle that closes below the first
    level or above the last is lost.
    """
    contours = level_contours(mesh, values, levels)
    slabs = slab_components(mesh, contours)
    pairs = []
    for component in np.unique(slabs.above):
        lower, upper = np.flatnonzero(slabs.above == component), np.flatnonzero(slabs.below == component)
        pairs.append(np.stack(np.meshgrid(lower, upper, indexing="ij"), axis=-1).reshape(-1, 2))
    arcs, count = np.concatenate(pairs), len(contours.level)
    return len(arcs) - count + arc_components(arcs, count)
