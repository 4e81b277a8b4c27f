"""Which filter suits a map, by the map alone: does a step take total variation and a slope the heat kernel?"""

import numpy as np

import surfexp as sx

# %%
# No clean map is used: the error of each filter is estimated from the noisy map alone, by Stein's estimate, and the filter with
# the least is taken. Total variation keeps a step, the heat kernel a slope.
sphere = sx.shape("icosphere", levels=4)
height = sphere.mesh.vertices[:, 2]
pictures = []
for name, clean in {"a step": 3.0 * (height > 0), "a slope": 2.0 * height}.items():
    noisy = clean + np.random.default_rng(0).normal(0, 1, len(clean))
    found = sx.denoise(sphere, noisy)
    error = np.sqrt(np.average((found.values - clean) ** 2, weights=sphere.mesh.vertex_areas))
    print(f"{name}: {found.certificate['chosen'].replace('_', ' ')}, error {error:.2f} of noise 1")
    for shown, field in (("with noise", noisy), ("filtered", found.values)):
        pictures.append(sx.plot(sphere, field, colormap="RdBu_r", limits=(-4, 4), label=f"{name}, {shown}", width=400))
