"""Two loops for two handles: the Reeb graph of a height on the double torus, sampled and exact."""

import numpy as np

from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.reeb_graph import reeb_graph

mesh = genus_surface(genus=2, count=4000).mesh
height = mesh.vertices @ np.array([1.0, 0.15, 0.2])
sampled = reeb_graph(mesh, height, choose_levels(mesh, height, 10, "uniform"))
exact = exact_reeb_graph(mesh, height)
loops = len(exact.arcs) - len(exact.vertices) + 1
print(f"sampled: {sampled.metrics['b1']:.0f} loops; exact: {loops} loops, {len(exact.vertices)} critical points")
