"""Two drums side by side: equal spectra, different nodal counts, different outlines."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shapes.isospectral_drum import TILES, Gluing, TransplantationPair, glued_drum, tile_layout, tile_mesh
from surfexp.operators.elements_surface import Boundary
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import EigenSystem, measure
from surfexp.spectrum.nodal_graph import element_faces, nodal_graph
from surfexp.spectrum.nodal_signature import counted_domains

from .drum_elements import drum_elements
from .transplantation import transplant


@dataclass(frozen=True, eq=False)
class DrumComparison:
    """What was found of two drums.

    Parameters
    ----------
    first, second : EigenSystem
    first_counts, second_counts : (k,) int64
        Filtered nodal numbers.
    transplanted : float
        Largest residual, relative to the last eigenvalue, of the eigenfunctions of the first drum carried to the second.
    outline_difference : float
        Largest difference of the sorted distances between the corners of the two outlines; infinite where their numbers
        differ. Above 0 the drums are not congruent.
    """

    first: EigenSystem
    second: EigenSystem
    first_counts: Integers
    second_counts: Integers
    transplanted: float
    outline_difference: float

    @property
    def spectral_difference(self) -> float:
        """Largest relative difference of the eigenvalues."""
        one, two = self.first.values, self.second.values
        return float((np.abs(one - two) / np.maximum(one, one[min(1, len(one) - 1)])).max())

    @property
    def differing_modes(self) -> Integers:
        """Numbers, from 1, of the modes whose nodal numbers differ."""
        return np.flatnonzero(self.first_counts != self.second_counts) + 1


def compare_drums(
    pair: TransplantationPair,
    triangle: Floats,
    divisions: int = 14,
    count: int = 20,
    order: int = 2,
    grading: float = 2.0,
    boundary: Boundary = "dirichlet",
    tolerance: float = 1e-11,
) -> DrumComparison:
    """Mesh both drums of a pair tile by tile, and compare spectra, nodal counts and outlines."""
    systems, counts, assembled = [], [], []
    for gluing in (pair.first, pair.second):
        elements = drum_elements(glued_drum(gluing, triangle, *tile_mesh(divisions, grading)), order, boundary)
        found = eigenpairs(elements.stiffness, elements.mass, count, tolerance=tolerance)
        system = replace(
            found, vectors=elements.extend(found.vectors), area=elements.area, order=order, boundary=boundary
        )
        assembled.append(elements)
        graph = nodal_graph(element_faces(elements.nodes), elements.nodes.count)
        systems.append(system)
        counts.append(counted_domains(system, graph, "filtered").astype(np.int64))
    carried = transplant(pair, systems[0].vectors, assembled[0].nodes, assembled[1].nodes, boundary)[0]
    moved = carried[assembled[1].free]
    measurement = measure(assembled[1].stiffness, assembled[1].mass, moved / np.linalg.norm(moved, axis=0))
    return DrumComparison(
        *(systems[0], systems[1], counts[0], counts[1]),
        transplanted=float(measurement.errors.max() / systems[0].values[-1]),
        outline_difference=outline_difference(pair.first, pair.second, triangle),
    )


def outline_difference(first: Gluing, second: Gluing, triangle: Floats) -> float:
    """Compare the distances between the corners of the outlines, which congruent drums have in common."""
    spreads = []
    for gluing in (first, second):
        corners = outline_corners(gluing, triangle)
        spreads.append(np.sort(np.linalg.norm(corners[:, None] - corners[None], axis=2).ravel()))
    if len(spreads[0]) != len(spreads[1]):
        return float("inf")
    return float(np.abs(spreads[0] - spreads[1]).max())


def outline_corners(gluing: Gluing, triangle: Floats) -> Floats:
    """(c, 2) ends of the tile sides on the boundary of a drum, each place once."""
    tiles = tile_layout(gluing, triangle)
    ends = [
        tiles[tile, (side + step) % 3]
        for side, permutation in enumerate(gluing)
        for tile in range(TILES)
        if permutation[tile] == tile
        for step in (1, 2)
    ]
    return np.unique(np.round(np.array(ends), 9), axis=0)
