"""Nodal counts tell isospectral drums apart."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.shapes.isospectral_drum import GORDON_WEBB_WOLPERT, RIGHT_ISOSCELES, glued_drum, tile_mesh
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.nodal_domains import (
    filtered_nodal_counts,
    nodal_counts,
    nodal_thresholds,
)
from surfexp.spectrum.nodal_graph import element_faces, nodal_graph
from surfexp.spectrum.soft_nodal_counts import soft_nodal_counts
from surfexp_studies.drums.drum_elements import drum_elements


def counted(elements, k: int):
    """Eigensystem, raw, filtered and soft counts of the first k modes."""
    system = eigenpairs(elements.stiffness, elements.mass, k)
    functions = elements.extend(system.vectors)
    graph = nodal_graph(element_faces(elements.nodes), elements.nodes.count)
    saddles, peaks = nodal_thresholds(np.maximum(system.values, 1e-3), elements.area, elements.nodes.count)
    soft = soft_nodal_counts(graph, functions, saddles, peaks)
    return system, nodal_counts(graph, functions), filtered_nodal_counts(graph, functions, saddles, peaks), soft


def test_gordon_webb_wolpert_drums_are_told_apart_at_the_fourth_mode() -> None:
    counts = []
    for gluing in (GORDON_WEBB_WOLPERT.first, GORDON_WEBB_WOLPERT.second):
        drum = glued_drum(gluing, RIGHT_ISOSCELES, *tile_mesh(14, 2.0))
        counts.append(counted(drum_elements(drum, 2), 10)[2])
    first, second = counts
    assert first[:5].tolist() == [1, 2, 3, 3, 4] and second[:5].tolist() == [1, 2, 3, 4, 4]
    assert first[8:].tolist() == second[8:].tolist() == [7, 4]
