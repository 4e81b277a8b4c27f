"""Newton's method to a gap of 1e-10, and the closed form for the indicator of a cap on the sphere."""

import numpy as np

from surfexp.mesh.shapes.spherical_cap import capped_sphere
from surfexp.operators.fem import fem
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solvers.newton import newton

surface, mu = capped_sphere(1.0, rings=24), 12.0
operator, angle = fem(surface.mesh), surface.coordinates[:, 0]
image = np.where(np.abs(angle - 1.0) < 1e-9, 0.5, np.where(angle < 1.0, 1.0, 0.0))
solution = newton(rof(operator.mass, image, mu), operator)
exact = 1.0 - np.sin(1.0) / (mu * (1.0 - np.cos(1.0)))
print(f"inside the cap {solution.values[0]:.4f}, exactly {exact:.4f}, relative gap {solution.relative_gap:.0e}")
