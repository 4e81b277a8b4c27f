"""Error of the first 24 eigenvalues of the unit sphere by element order, flat and curved, at 2,562 unknowns or so."""

import numpy as np

import surfexp as sx
from surfexp.operators.elements_surface import surface_elements

exact = np.array([degree * (degree + 1) for degree in range(1, 5) for _ in range(2 * degree + 1)])
for name, levels, order, curved in [
    ("P1", 4, 1, False),
    ("P2 flat", 3, 2, False),
    ("P2", 3, 2, True),
    ("P3", 3, 3, True),
]:
    project = (lambda points: points / np.linalg.norm(points, axis=1, keepdims=True)) if curved else None
    elements = surface_elements(sx.shape("icosphere", levels=levels).mesh, order, project)
    values = sx.eigsh(elements.stiffness, 25, elements.mass, sigma=0.0)[0][1:]
    print(f"{name:8s} {np.abs(values / exact - 1).max():.1e}")
