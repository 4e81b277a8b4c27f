"""How long is the largest sulcus of the left side, and the one in its place on the right?"""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import surfexp as sx

# %%
# The floors of sulci are where the curvature is most negative, with a short boundary; each connected piece is one region.


def regions(brain):
    edges, areas, n = brain.mesh.edges, brain.mesh.vertex_areas, len(brain.vertices)
    inside = sx.segment(brain, np.clip(sx.mean_curvature(brain), -0.5, 0.5), smoothness=0.3).labels == 0
    kept = edges[inside[edges].all(axis=1)]
    _, piece = connected_components(coo_array((np.ones(len(kept)), kept.T), shape=(n, n)), directed=False)
    return piece, np.bincount(piece, areas * inside)


# %%
# The whole faces of a region are a surface of its own; repair cuts it where it hangs together by a vertex alone. Its first
# mode runs from one end to the other: the Reeb graph of it is the line of the sulcus, and the geodesic distance of the
# two ends is the length.


def line(brain, inside):
    whole = brain.faces[inside[brain.faces].all(axis=1)]
    region = sx.repair((brain.vertices, whole), largest_component=True)
    along = sx.eigenpairs(region, 2).vectors[:, 1]
    ends = int(np.nanargmin(along)), int(np.nanargmax(along))
    return sx.reeb_graph(region, along, count=30, persistence=0.2), float(sx.geodesic(region, ends[0])[ends[1]])


# %%
# The largest region of the left side, and the region of the right side whose middle is nearest to its mirror image.
middle, pictures = None, []
for side in ("left", "right"):
    brain = sx.shape("fsaverage5", hemisphere=side, sheet="pial")
    piece, sizes = regions(brain)
    middles = np.array([brain.vertices[piece == k].mean(axis=0) for k in np.flatnonzero(sizes > 100.0)])
    if middle is None:
        chosen = np.argmax(sizes)
        middle = brain.vertices[piece == chosen].mean(axis=0) * (-1.0, 1.0, 1.0)
    else:
        chosen = np.flatnonzero(sizes > 100.0)[np.linalg.norm(middles - middle, axis=1).argmin()]
    graph, length = line(brain, piece == chosen)
    print(f"{side}: {sizes[chosen]:.0f} mm^2, {length:.0f} mm long, one line: {graph.is_chain}")
    inflated = sx.shape("fsaverage5", hemisphere=side, sheet="inflated")
    pictures.append(sx.plot(inflated, piece == chosen, views="lateral", width=500))
    pictures.append(sx.plot(brain, skeleton=graph, views="lateral", width=500))
