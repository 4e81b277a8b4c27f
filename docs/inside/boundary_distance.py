"""Distance to the boundary of a rectangle by three methods, against the exact one, in edge lengths."""

import numpy as np

from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.skeleton.boundary_distance import boundary_distance

mesh = rectangle(61, 25, 2.5, 1.0).mesh
x, y, _ = mesh.vertices.T
exact = np.minimum(np.minimum(x, 2.5 - x), np.minimum(y, 1.0 - y))
for method in ("exact", "fast_marching", "heat"):
    error = np.abs(boundary_distance(mesh, method) - exact).mean() / mesh.edge_length
    print(f"{method}: mean error {error:.3f}")
