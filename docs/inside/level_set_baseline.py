"""Segment a noisy cap on the sphere: intrinsically, and on ever finer grids around it; the share of the gain that is lost falls."""

import numpy as np

from surfexp.baselines.closest_point import closest_point
from surfexp.baselines.energy_excess import energy_excess
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.separable_quadratic import convex_chan_vese
from surfexp.variational.solvers.primal_dual import primal_dual

mesh = icosphere(4).mesh
image = (mesh.vertices[:, 2] > 0.6) + np.random.default_rng(0).normal(0, 0.3, len(mesh.vertices))
operator = fem(mesh)
fidelity = convex_chan_vese(operator.mass, ((1 - image) ** 2 - image**2) / (3 * mesh.edge_length))
intrinsic = primal_dual(fidelity, operator, tolerance=1e-4)
for step in (0.2, 0.1, 0.05):
    solution = closest_point(mesh, step)(fidelity, operator)
    excess = energy_excess(fidelity, operator, solution.values, intrinsic.lower_bound)
    print(f"grid step {step}: {solution.metrics['node_count']:.0f} nodes, excess {excess:.4f}")
