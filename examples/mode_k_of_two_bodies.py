"""Is mode k of one body mode k of another that is bent a little?"""

import matplotlib.pyplot as plt
import numpy as np

import surfexp as sx

# %%
# The copy has the same vertices in other places, so that the counterpart of each mode is known: it is the mode of the copy
# with which the correlation over the surface is largest.
body = sx.shape("ellipsoid", levels=4, semiaxes=(1.0, 1.3, 1.7))
x, y, z = body.vertices.T
bend = 0.12 * np.stack([np.sin(2.0 * z), np.cos(3.0 * x) + z * x, np.sin(2.0 * y + x)], axis=1)
copy = sx.Surface((body.vertices + bend, body.faces))
one, other = (sx.eigenpairs(surface, 31).vectors[:, 1:] for surface in (body, copy))
root = np.sqrt(copy.mesh.vertex_areas)[:, None]


def correlations(modes, others):
    first, second = (root * some / np.linalg.norm(root * some, axis=0) for some in (modes, others))
    return np.abs(first.T @ second)


alike = correlations(one, other)
same = alike.argmax(axis=1) == np.arange(30)
print(f"mode k is mode k for {same[:10].sum()} of the first ten modes, for {same[10:].sum()} of the next twenty")

# %%
# Alignment mixes modes of nearly equal eigenvalues, and finds the signs of the others with a proof where it can. It needs no
# known counterparts.
aligned = correlations(one, sx.align(body, copy, 30).vectors)
means = [matrix.diagonal().mean() for matrix in (alike, aligned)]
print(f"correlation with the mode of its number: {means[0]:.2f} as they come, {means[1]:.2f} aligned")
figure, panels = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for axes, matrix, title in zip(panels, (alike, aligned), ("as they come", "aligned"), strict=True):
    shown = axes.imshow(matrix, vmin=0.0, vmax=1.0, cmap="Greys", extent=(0.5, 30.5, 30.5, 0.5))
    axes.set(title=title, xlabel="mode of the copy", ylabel="mode of the body")
figure.colorbar(shown, ax=panels, label="size of the correlation")
