"""How far are the eigenvalues of a mesh from those of the smooth surface, and what do two meshes say together?"""

import matplotlib.pyplot as plt
import numpy as np

import surfexp as sx

# %%
# The sphere has the eigenvalues l (l + 1), each 2 l + 1 times. On meshes of ever smaller triangles the first 25 come
# nearer: half the length of an edge, a quarter of the error.
degrees = np.arange(5)
exact = np.repeat(degrees * (degrees + 1.0), 2 * degrees + 1)
spheres = [sx.shape("icosphere", levels=levels) for levels in (2, 3, 4, 5)]
edges = np.array([sphere.mesh.edge_length for sphere in spheres])
values = np.array([sx.eigenpairs(sphere, len(exact)).values for sphere in spheres])
errors = np.abs(values[:, 1:] / exact[1:] - 1.0).max(axis=1)
orders = np.diff(np.log(errors)) / np.diff(np.log(edges))
print("largest relative error " + ", ".join(f"{error:.1e}" for error in errors))
print("order " + ", ".join(f"{order:.2f}" for order in orders))

# %%
# As the order is known, two meshes say where the values go: the finer one, and a third of what it changed. No exact value
# is used, so this works on any surface of which there are two meshes.
extrapolated = values[1:] + (values[1:] - values[:-1]) / 3.0
better = np.abs(extrapolated[:, 1:] / exact[1:] - 1.0).max(axis=1)
print(f"on {len(spheres[-1].vertices)} vertices {errors[-1]:.1e}, with the coarser mesh beside it {better[-1]:.1e}")
figure, axes = plt.subplots(figsize=(6, 4))
axes.loglog(edges, errors, "o-", label="one mesh")
axes.loglog(edges[1:], better, "s-", label="two meshes, extrapolated")
axes.set(xlabel="mean length of an edge, in radii", ylabel="largest relative error of 24 eigenvalues")
axes.legend()
