"""Do the thickness and the depth of a cortex correlate beyond chance, when neighbours are not independent?"""

import numpy as np
from scipy.stats import pearsonr

import surfexp as sx

brain = sx.shape("fsaverage5", hemisphere="left", sheet="pial")
thickness = np.where(brain.scalars["thickness"] < 1.0, np.nan, brain.scalars["thickness"])  # without the medial wall

# %%
# Neighbours on a cortex are alike, so that Student's test counts the same evidence many times. Null maps are random and as
# smooth as the map: the correlation is compared with theirs.
found = sx.compare_maps(brain, thickness, "sulc", count=499)
low, high = found.interval
print(
    f"r = {found.r:.2f} ({low:.2f} to {high:.2f}), p = {found.p:.3f}, as {found.observations:.0f} independent vertices"
)
print(found.reason)

# %%
# The same test on a map that has nothing to do with thickness.
random = sx.smooth(brain, np.random.default_rng(1).standard_normal(len(thickness)), 20.0).values
chance, known = sx.compare_maps(brain, thickness, random, count=499), np.isfinite(thickness)
naive = pearsonr(thickness[known], random[known])
print(
    f"with a random map r = {chance.r:.2f}, p = {chance.p:.2f}; Student's test of vertices says p = {naive.pvalue:.0e}"
)
picture = sx.plot(brain, found, views=("lateral",), width=400)
picture.save("null_maps.png")
