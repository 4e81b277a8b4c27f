"""How far do noise and a lost handle move the Reeb graph of a torus, and is the distance proved?"""

import matplotlib.pyplot as plt
import numpy as np

import surfexp as sx

# %%
# The distance of two Reeb graphs is at most the largest difference of the maps. From below it is proved by persistence and merge
# trees, from above by a space of which both are Reeb graphs.
torus = sx.shape("torus", n_u=60, n_v=24)
height = torus.mesh.vertices[:, 0]
smooth = sx.reeb_graph(torus, height)
noise = np.random.default_rng(0).standard_normal(len(height))
levels = [0.01, 0.02, 0.03, 0.04, 0.05]
graphs = [sx.reeb_graph(torus, height + level * noise) for level in levels]
bounds = [sx.reeb_distance(smooth, graph) for graph in graphs]
for level, found in zip(levels, bounds, strict=True):
    largest = level * np.abs(noise).max()
    print(f"noise {largest:.3f} at most: distance {found.lower:.4f} to {found.upper:.4f}, proved: {found.proved}")

# %%
# A sphere of the same height has no handle. The loop of the torus is 1.2 high, and half of that is the distance.
sphere = sx.shape("icosphere", levels=4, radius=1.4)
lost = sx.reeb_distance(smooth, sx.reeb_graph(sphere, sphere.mesh.vertices[:, 0]))
print(f"the lost handle: {lost.lower:.3f} to {lost.upper:.3f}")

# %%
# Both bounds lie below the largest noise, which few vertices have.
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for a, b in graphs[1].arcs:
    left.plot(graphs[1].positions[[a, b], 1], graphs[1].values[[a, b]], color="black", linewidth=1)
left.set(title=f"Reeb graph, noise {levels[1]}", xlabel="place", ylabel="height")
largest = np.array(levels) * np.abs(noise).max()
right.fill_between(largest, [found.lower for found in bounds], [found.upper for found in bounds], alpha=0.4)
right.plot(largest, largest, color="black", linestyle="--")
right.annotate("largest noise", (largest[-2], largest[-2]), (-80, 0), textcoords="offset points")
right.set(title="bounds on the distance", xlabel="largest noise", ylabel="distance")
figure.savefig("noise_on_a_reeb_graph.png")
