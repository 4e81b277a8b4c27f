"""Eigenvalues of the Gordon-Webb-Wolpert drum, extrapolated from three graded meshes, and the exact ninth, 5 pi^2 / 4."""

import numpy as np

from surfexp.mesh.shapes.isospectral_drum import GORDON_WEBB_WOLPERT, RIGHT_ISOSCELES
from surfexp_studies.drums.drum_values import drum_values

found = drum_values(GORDON_WEBB_WOLPERT.first, RIGHT_ISOSCELES, 10, divisions=(16, 20, 28))
print(" ".join(f"{value:.8f}" for value in found.values))
print(f"ninth off by {abs(found.values[8] / (1.25 * np.pi**2) - 1.0):.0e}")
print(f"before extrapolation by {abs(found.computed[-1, 8] / (1.25 * np.pi**2) - 1.0):.0e}")
