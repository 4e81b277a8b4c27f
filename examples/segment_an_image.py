"""Where are the two regions of a noisy image on a sphere, by the convex Chan-Vese model?"""

import numpy as np

import surfexp as sx

# %%
# A cap with noise that is nearly half as large as the contrast.
sphere = sx.shape("icosphere", levels=4)
cap, areas = sphere.mesh.vertices[:, 2] > 0.4, sphere.mesh.vertex_areas
noisy = np.where(cap, 255.0, 0.0) + np.random.default_rng(0).normal(0, 100, len(cap))

# %%
# The model weighs the length of the boundary against the two means. It is convex: what is found does not depend on a start.
parts = sx.segment(sphere, noisy, smoothness=1.0)
found = parts.labels == 1
dice = 2.0 * areas[cap & found].sum() / (areas[cap].sum() + areas[found].sum())
print(f"dice {dice:.3f}, boundary {parts.perimeter:.2f} (a circle has 5.76)")
pictures = [sx.plot(sphere, image, colormap="gray", width=500) for image in (noisy, found)]
