"""Do thirty bodies fall into their families in the plane, by multidimensional scaling of the distances of their spectra?"""

import numpy as np
from sklearn.manifold import smacof
from sklearn.metrics import pairwise_distances

import surfexp as sx

# %%
# Thirty bodies of three families.
random = np.random.default_rng(0)
families = {"long": (2.0, 1.2, 0.9), "flat": (1.6, 1.3, 0.5), "round": (1.15, 1.0, 0.85)}
names = np.repeat(list(families), 10)
bodies = [sx.shape("ellipsoid", levels=2, semiaxes=tuple(random.normal(families[name], 0.02))) for name in names]

# %%
# Distances of their spectra, and points of the plane with nearly the same distances. The axes mean nothing, only distances do.
distances = pairwise_distances(sx.ShapeDNA(n=12).fit_transform(bodies))
points, _ = smacof(distances, n_components=2, n_init=4, normalized_stress=False, random_state=0)
for name in families:
    x, y = points[names == name].mean(axis=0)
    print(f"{name}: {x:6.2f} {y:6.2f}")
nearest = np.argmin(distances + 1e9 * np.eye(len(names)), axis=1)
print(f"{np.sum(names[nearest] == names)} of {len(names)} are nearest to one of their own family")
pictures = [sx.plot(body, width=400) for body in bodies[::10]]
