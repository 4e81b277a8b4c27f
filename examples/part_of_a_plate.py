"""What are the lowest frequencies of the left half of a plate, with a free and with a held boundary?"""

import numpy as np

import surfexp as sx

# %%
# A mask makes a surface of a part: nothing is cut by hand, and results stand on the vertices of the whole.
plate = sx.shape("rectangle", n_x=61, n_y=41, width=1.5, height=1.0)
half = sx.Surface(plate.mesh, mask=plate.mesh.vertices[:, 0] < 0.75 + 1e-9)

# %%
# The boundary of the part is free, or held.
free = sx.eigenpairs(half, 4)
held = sx.eigenpairs(half, 4, boundary="dirichlet")
print(f"free: {free.values[1]:.3f}, exactly {np.pi**2:.3f}; all found: {free.complete}")
print(f"held: {held.values[0]:.3f}, exactly {np.pi**2 * (1 / 0.75**2 + 1):.3f}; all found: {held.complete}")
print(f"modes have a value at {np.isfinite(free.vectors[:, 0]).sum()} of {len(free.vectors)} vertices")
picture = sx.plot(half, held.vectors[:, 3], label="mode 4, held", width=800)
