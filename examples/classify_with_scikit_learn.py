"""Does a pipeline of scikit-learn tell three families of bodies apart by their spectra?"""

import numpy as np
from sklearn.model_selection import cross_val_score
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

import surfexp as sx

# %%
# Fifteen ellipsoids of three families, with axes that vary a little.
random = np.random.default_rng(0)
families = {"long": (2.0, 1.0, 1.0), "flat": (1.5, 1.5, 0.6), "round": (1.1, 1.0, 0.9)}
names = [name for name in families for _ in range(5)]
bodies = [sx.shape("ellipsoid", levels=2, semiaxes=tuple(random.normal(families[name], 0.1))) for name in names]

# %%
# `sx.ShapeDNA` is a transformer: it turns surfaces into rows of eigenvalues, scaled so that size does not count. What follows is
# scikit-learn as usual.
pipeline = make_pipeline(sx.ShapeDNA(n=10), StandardScaler(), KNeighborsClassifier(n_neighbors=3))
scores = cross_val_score(pipeline, bodies, names, cv=5)
print(f"{100 * scores.mean():.0f} % of {len(bodies)} bodies in the right family")
pictures = [sx.plot(body, width=400) for body in bodies[::5]]
