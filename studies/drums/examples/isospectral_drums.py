"""Two drums of different shape that sound the same, and the fourth mode whose nodal domains tell them apart."""

from surfexp.mesh.shapes.isospectral_drum import GORDON_WEBB_WOLPERT, RIGHT_ISOSCELES, glued_drum, tile_mesh
from surfexp.operators.elements_surface import SurfaceElements
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.nodal_domains import filtered_nodal_counts, nodal_thresholds
from surfexp.spectrum.nodal_graph import element_faces, nodal_graph
from surfexp_studies.drums.drum_elements import drum_elements


def listen(elements: SurfaceElements) -> None:
    """Print the first eigenvalues of a drum and the numbers of their nodal domains."""
    system = eigenpairs(elements.stiffness, elements.mass, 5, "slicing", tolerance=1e-10)
    graph = nodal_graph(element_faces(elements.nodes), elements.nodes.count)
    thresholds = nodal_thresholds(system.values, elements.area, elements.nodes.count)
    counts = filtered_nodal_counts(graph, elements.extend(system.vectors), *thresholds)
    print(" ".join(f"{value:.11f}" for value in system.values), "nodal domains", *counts)


for gluing in (GORDON_WEBB_WOLPERT.first, GORDON_WEBB_WOLPERT.second):
    listen(drum_elements(glued_drum(gluing, RIGHT_ISOSCELES, *tile_mesh(14, 2.0)), order=2))
