"""Carry a mode of one drum to the drum that sounds the same: sums of three tiles each make a mode again (Berard 1992)."""

import numpy as np

from surfexp.mesh.shapes.isospectral_drum import GORDON_WEBB_WOLPERT as PAIR
from surfexp.mesh.shapes.isospectral_drum import RIGHT_ISOSCELES, glued_drum, tile_mesh
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp_studies.drums.drum_elements import drum_elements
from surfexp_studies.drums.transplantation import transplant

one, two = (drum_elements(glued_drum(g, RIGHT_ISOSCELES, *tile_mesh(10, 2.0)), 2) for g in (PAIR.first, PAIR.second))
system = eigenpairs(one.stiffness, one.mass, 5, tolerance=1e-11)
moved, tear = transplant(PAIR, one.extend(system.vectors), one.nodes, two.nodes, "dirichlet")
inside = moved[two.free]
residual = two.stiffness @ inside - two.mass @ inside * system.values
print(f"pieces fit: {tear < 1e-12}, still modes: {np.abs(residual).max() < 1e-9}")
