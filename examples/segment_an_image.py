"""Find the two regions of a noisy image on a sphere by the convex Chan-Vese model."""

import numpy as np

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.solvers.split_bregman import split_bregman

mesh = icosphere(4).mesh
cap = mesh.vertices[:, 2] > 0.4
noisy = Image(np.where(cap, 255.0, 0.0) + np.random.default_rng(0).normal(0, 100, len(cap)), labels={"cap": cap})
solution = ConvexChanVese(smoothness=1.0).run(noisy, fem(mesh), split_bregman)
print(f"dice {solution.metrics['dice cap']:.3f}, boundary {solution.metrics['perimeter']:.2f} (a circle has 5.76)")
