"""How far apart are a body and its copy of another size, turned and renumbered, and where does each vertex go?"""

import numpy as np

import surfexp as sx

# %%
# A body without symmetry, and a copy that is twice as large, turned, and numbered anew.
mesh = sx.shape("ellipsoid", levels=3).mesh
x, y, z = mesh.vertices.T
body = np.stack([x + 0.4 * y**2 + 0.3 * y * z, y + 0.3 * z**2, z * (1.0 + 0.3 * x)], axis=1)  # without symmetry
random = np.random.default_rng(0)
order, turn = random.permutation(len(body)), np.linalg.qr(random.normal(size=(3, 3)))[0]
turn *= np.linalg.det(turn)
copy = 2.0 * body[order] @ turn.T, np.argsort(order)[mesh.faces]

# %%
# Eigenfunctions know neither pose nor numbering, but each has a sign of its own on either body. The search over signs proves its
# result, and each vertex of the copy goes to the nearest one in the space of eigenfunctions.
found = sx.distance((body, mesh.faces), copy, n=10)
right = np.mean(found.correspondence == order)
print(f"distance {found.value:.1e}, proved least: {found.optimal}, {100 * right:.0f} % of the vertices find their own")
coloured = x, x[found.correspondence]
pictures = [sx.plot(shape, field, width=500) for shape, field in zip(((body, mesh.faces), copy), coloured, strict=True)]
