"""How much noise leaves the thickness of a cortex, when nothing is known on its medial wall?"""

import numpy as np

import surfexp as sx

brain = sx.shape("fsaverage5", hemisphere="left")
thickness = brain.scalars["thickness"]
noisy = thickness + np.random.default_rng(0).normal(0, 0.5, len(thickness))
noisy[thickness < 1.0] = np.nan  # the medial wall
clean = sx.denoise(brain, noisy)
known, areas = np.isfinite(noisy), brain.mesh.vertex_areas
before, after = (np.sqrt(np.average((m - thickness)[known] ** 2, weights=areas[known])) for m in (noisy, clean.values))
print(f"{known.sum()} of {len(known)} vertices, noise estimated as {clean.certificate['noise']:.2f} mm")
print(f"error {before:.2f} mm before, {after:.2f} mm after; relative gap {clean.certificate['relative_gap']:.0e}")
sx.write("thickness.shape.gii", clean, brain)
picture = sx.plot(brain, clean, views=("lateral", "medial"), label="thickness", unit="mm", width=800)
