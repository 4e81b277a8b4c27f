"""Which shape has the part of a torus right of a plane, by the Reeb graph of the distance from its leftmost vertex?"""

import networkx
import numpy as np

import surfexp as sx

# %%
# The part of a torus right of a plane, as a mask.
torus = sx.shape("torus", n_u=80, n_v=32)
x = torus.mesh.vertices[:, 0]
patch = sx.Surface(torus.mesh, mask=x > -0.4)

# %%
# The Reeb graph joins the contours of the distance, level by level: a chain means that no contour splits for good.
reached = sx.geodesic(patch, int(np.argmin(np.where(patch.mask, x, np.inf))))
graph = sx.reeb_graph(patch, reached, count=20, persistence=0.1)
print(
    f"{len(graph.positions)} nodes, {len(graph.arcs)} arcs, {graph.metrics['b1']:.0f} loops, a chain: {graph.is_chain}"
)
print(f"farthest vertex at {np.nanmax(reached):.2f}")
networkx.write_graphml(graph.graph(), "patch.graphml")
sx.write("patch.vtk", {"distance": reached}, torus)
picture = sx.plot(patch, reached, label="distance", width=800)
