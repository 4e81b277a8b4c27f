"""The Laplacian of a drum, and the values that the literature has of it."""

from __future__ import annotations

from surfexp.mesh.shapes.isospectral_drum import Drum
from surfexp.operators.elements_nodes import flat_positions, number_nodes
from surfexp.operators.elements_surface import Boundary, SurfaceElements, assemble_elements

# Dirichlet eigenvalues of the Gordon-Webb-Wolpert drums with a right isosceles tile of legs 2 (Driscoll 1997)
GORDON_WEBB_WOLPERT_VALUES = (
    *(2.53794399980, 3.65550971352, 5.17555935622, 6.53755744376, 7.24807786256),
    *(9.20929499840, 10.5969856913, 11.5413953956, 12.3370055014, 13.0536540557),
)


def drum_elements(drum: Drum, order: int = 1, boundary: Boundary = "dirichlet") -> SurfaceElements:
    """Assemble the Laplacian of a drum with elements of the given order."""
    nodes = number_nodes(drum.faces, len(drum.vertices), order)
    return assemble_elements(nodes, flat_positions(drum.corners, order), boundary=boundary)
