"""The weight (5.10) from the flux of the distance to the edge, and the eigenmap that it gives, on a corpus callosum."""

from surfexp.operators.fem import fem
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.eigenmap import eigenmap
from surfexp.skeleton.flux import flux, flux_weights, weighted_operator
from surfexp_studies.skeletons.callosum import callosum

mesh = callosum(seed=0).mesh
outflow = flux(mesh, boundary_distance(mesh))
for alpha in (1.0, 0.25):
    weights = flux_weights(outflow, alpha)
    feature = eigenmap(weighted_operator(fem(mesh), weights))
    eigenvalue = feature.metrics["eigenvalue"]
    print(f"alpha {alpha:g}: weights {weights.min():.2f} to {weights.max():.2f}, eigenvalue {eigenvalue:.6f}")
