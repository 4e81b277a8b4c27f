"""Do spectra tell three families of ellipsoids apart, whatever their size?"""

import numpy as np
from scipy.spatial.distance import pdist
from sklearn.decomposition import PCA

import surfexp as sx

# %%
# Three families, each in two sizes.
labels, bodies = [], []
for name, axes in (("long", (2.0, 1.0, 1.0)), ("flat", (1.5, 1.5, 0.6)), ("round", (1.1, 1.0, 0.9))):
    for size in (1.0, 1.5):
        labels.append(f"{name} {size}")
        bodies.append(sx.shape("ellipsoid", levels=3, semiaxes=tuple(size * axis for axis in axes)))

# %%
# Eigenvalues are scaled by the area: a body and its larger copy fall on one point. The plane shows the two directions in which
# spectra differ most.
spectra = sx.ShapeDNA(n=20).fit_transform(bodies)
points = PCA(2).fit_transform(spectra)
for label, (x, y) in zip(labels, points, strict=True):
    print(f"{label}: {x:6.2f} {y:6.2f}")
stress = np.linalg.norm(pdist(spectra) - pdist(points)) / np.linalg.norm(pdist(spectra))
print(f"stress {stress:.3f}")
pictures = [sx.plot(body, width=400) for body in bodies[::2]]
