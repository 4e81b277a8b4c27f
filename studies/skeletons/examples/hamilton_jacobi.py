"""Thinning against the Reeb graph of the eigenmap: branches of the one, a chain of the other, on a strip with jagged edges."""

from surfexp.mesh.shapes.strip import strip
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.hamilton_jacobi import hamilton_jacobi_skeleton
from surfexp_studies.skeletons.skeleton_study import eigenmap_skeleton

mesh = strip(jag=0.4).mesh
thinned = hamilton_jacobi_skeleton(mesh, boundary_distance(mesh))
chain, _ = eigenmap_skeleton(mesh)
for skeleton in (thinned, chain):
    ends, forks = skeleton.metrics["leaves"], skeleton.metrics["branch_nodes"]
    print(f"{skeleton.method}: {ends:.0f} ends, {forks:.0f} forks, {skeleton.metrics['b1']:.0f} loops")
