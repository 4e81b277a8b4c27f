"""Do the modes of a cortex rebuild its thickness better than those of a sphere?"""

import numpy as np

import surfexp as sx

brain, sphere = (sx.shape("fsaverage5", hemisphere="left", sheet=sheet) for sheet in ("white", "sphere"))
thickness = brain.scalars["thickness"]
cortex = thickness >= 1.0  # without the medial wall
weights = np.sqrt(brain.mesh.vertex_areas[cortex])

# %%
# Both surfaces have the same vertices, so that a mode of one is a map on the other. The map is fitted by least squares in
# the area of the cortex, by ever more of the lowest modes. Both spectra are proved complete.
bases = {
    name: sx.eigenpairs(sx.Surface(surface.mesh, mask=cortex), 200)
    for name, surface in (("its own", brain), ("the sphere's", sphere))
}
rebuilt = {}
for name, modes in bases.items():
    correlations = []
    for count in (10, 50, 200):
        basis = modes.vectors[cortex, :count]
        fit = basis @ np.linalg.lstsq(weights[:, None] * basis, weights * thickness[cortex], rcond=None)[0]
        correlations.append(f"{np.corrcoef(fit, thickness[cortex])[0, 1]:.3f} by {count}")
    rebuilt[name] = np.full(len(thickness), np.nan)
    rebuilt[name][cortex] = fit
    print(f"{name} modes, complete: {modes.complete}; correlation " + ", ".join(correlations))

# %%
# The difference is small: any smooth basis rebuilds a smooth map. A good fit by modes says little about the shape.
known = np.where(cortex, thickness, np.nan)
maps = {"thickness": known} | {f"by 200 of {name} modes": field for name, field in rebuilt.items()}
picture = sx.plot(brain, maps, views=("lateral", "medial"), limits=(1.5, 4.0), label="thickness", unit="mm", width=700)
