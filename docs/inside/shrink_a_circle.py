"""Geodesic curvature flow of a circle on the unit sphere, against cos a(t) = exp(t) cos a(0)."""

import numpy as np

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.level_sets import perimeters
from surfexp.variational.surface_flows import geodesic_curvature_flow

mesh = icosphere(4).mesh
operator = fem(mesh)
distance = 1.1 - np.arccos(np.clip(mesh.vertices[:, 2], -1.0, 1.0))
moved = geodesic_curvature_flow(operator, distance, time=0.4, steps=40)
length, exact = perimeters(operator, moved, np.zeros(1))[0], 2 * np.pi * np.sqrt(1 - (np.exp(0.4) * np.cos(1.1)) ** 2)
print(f"length {length:.3f}, exactly {exact:.3f}")
