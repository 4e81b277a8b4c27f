"""How near is a denoised image on a torus to the clean one, and how near to the exact minimiser?"""

import numpy as np

import surfexp as sx

# %%
# Stripes on a torus, with noise of 40 grey levels.
torus = sx.shape("torus", n_u=80, n_v=40)
clean = 255.0 * (np.sin(3 * torus.coordinates[:, 0]) > 0)
noisy = clean + np.random.default_rng(0).normal(0, 40, len(clean))

# %%
# Total variation denoising is a convex problem: a dual field gives a lower bound, and the gap to it proves how near the result
# is to the exact minimiser.
found = sx.denoise(torus, noisy, method="rof", noise=40.0)
error = np.sqrt(np.average((found.values - clean) ** 2, weights=torus.mesh.vertex_areas))
print(f"error {error:.1f} grey levels, relative gap {found.certificate['relative_gap']:.0e}")
pictures = [sx.plot(torus, image, colormap="gray", width=500) for image in (noisy, found)]
