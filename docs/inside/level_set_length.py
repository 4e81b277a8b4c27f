"""Measure the circle of latitude z = 0.3 of the unit sphere on ever finer meshes: the length converges at second order."""

import numpy as np

from surfexp.figures.level_set import level_set
from surfexp.linalg.convergence_order import convergence_order
from surfexp.mesh.shapes.icosphere import icosphere

meshes = [icosphere(levels).mesh for levels in range(2, 7)]
lengths = np.array([level_set(mesh, mesh.vertices[:, 2], 0.3).length for mesh in meshes])
errors = np.abs(lengths - 2.0 * np.pi * np.sqrt(1.0 - 0.3**2))
order = convergence_order(np.array([mesh.edge_length for mesh in meshes]), errors)
print(f"error {errors[-1]:.1e}, order {order:.2f}")
