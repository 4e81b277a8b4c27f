"""Can a reader check a spectrum, and a denoised map, without installing anything?"""

from pathlib import Path

import numpy as np

import surfexp as sx

# %%
# Eigenpairs and their inertia, or a map with its dual field, are all that a proof needs. The page holds them, and a script
# that computes the residuals, the counts or the gap again where it is read.
body = sx.shape("ellipsoid", levels=4)
modes = sx.proof_page(sx.eigenpairs(body, 20), body, title="Twenty modes of an ellipsoid")
noisy = np.sign(body.mesh.vertices[:, 0]) + np.random.default_rng(0).normal(0, 0.2, len(body.mesh.vertices))
clean = sx.proof_page(sx.denoise(body, noisy, method="rof"), title="A step without its noise")

# %%
# The pages ask no host. They turn red where a number in them is changed.
for name, page in (("modes.html", modes), ("step.html", clean)):
    page.save(name)
    print(f"{name}: {Path(name).stat().st_size / 1e6:.1f} MB, open it in any browser")
