"""What does a method on a grid need around a cortex, beside a method on its mesh?"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial import cKDTree

import surfexp as sx

# %%
# Level-set methods extend a map into space and compute on the nodes of a grid near the surface: here those within three
# spacings. A mesh has its vertices.
brain = sx.shape("fsaverage5", hemisphere="left", sheet="pial")
shares = np.array([(i, j, 6 - i - j) for i in range(7) for j in range(7 - i)]) / 6.0
samples = np.einsum("sk,fkx->fsx", shares, brain.vertices[brain.faces]).reshape(-1, 3)
tree, bands = cKDTree(samples), {}
print(f"mesh: {len(brain.vertices)} vertices, edges of {brain.mesh.edge_length:.1f} mm")
for spacing in (4.0, 2.0, 1.0):
    low, high = brain.vertices.min(axis=0) - 4 * spacing, brain.vertices.max(axis=0) + 4 * spacing
    steps = [np.arange(start, end, spacing) for start, end in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3)
    band = bands[spacing] = grid[np.isfinite(tree.query(grid, distance_upper_bound=3.0 * spacing)[0])]
    print(f"grid of {spacing:.0f} mm: {len(band)} nodes, {len(band) / len(brain.vertices):.1f} for each vertex")

# %%
# Where two banks of a sulcus are nearer than twice three spacings, they share nodes, and what is computed on one mixes
# with the other. On the mesh they are far apart.
normals = brain.mesh.vertex_normals
for spacing in (4.0, 2.0, 1.0):
    near = cKDTree(brain.vertices).query_ball_point(brain.vertices, 6.0 * spacing)
    facing = np.array([(normals[some] @ normal).min() < -0.5 for some, normal in zip(near, normals, strict=True)])
    share = brain.mesh.vertex_areas[facing].sum() / brain.mesh.area
    print(f"grid of {spacing:.0f} mm: {share:.0%} of the cortex shares nodes with another bank")
figure, panels = plt.subplots(1, 2, figsize=(9, 5), layout="constrained")
cut = samples[np.abs(samples[:, 1]) < 0.3]
for axes, spacing in zip(panels, (4.0, 1.0), strict=True):
    nodes = bands[spacing]
    slab = nodes[np.abs(nodes[:, 1] - nodes[np.abs(nodes[:, 1]).argmin(), 1]) < 0.1]
    axes.plot(slab[:, 0], slab[:, 2], ".", markersize=spacing)
    axes.plot(cut[:, 0], cut[:, 2], "k.", markersize=1.5)
    axes.set(
        title=f"nodes {spacing:.0f} mm apart around the cortex", xlabel="x in mm", ylabel="z in mm", aspect="equal"
    )
