"""How many nodal domains has mode n, and does another mesh of the same body give the same number?"""

import matplotlib.pyplot as plt
import numpy as np

import surfexp as sx

# %%
# A mode changes its sign on its nodal lines, which divide the surface. Courant's theorem allows mode n at most n parts;
# Pleijel's says that in the end there are fewer than .69 n.
semiaxes = (1.0, 1.3, 1.7)
bodies = [sx.shape("ellipsoid", levels=levels, semiaxes=semiaxes) for levels in (4, 5)]
counts = sx.NodalCounts(n=60).fit_transform(bodies)
numbers = np.arange(2, 62)
print(f"most domains by mode: {(counts[1] / numbers).max():.2f} n, in the mean {(counts[1] / numbers).mean():.2f} n")
print(f"the coarser mesh gives the same count for {np.mean(counts[0] == counts[1]):.0%} of the modes")

# %%
# Two modes whose eigenvalues are near may change places, and a line that just closes on one mesh stays open on the other.
figure, axes = plt.subplots(figsize=(6, 4))
for body, row, mark in zip(bodies, counts, "o.", strict=True):
    axes.plot(numbers, row, mark, fillstyle="none", label=f"{len(body.vertices)} vertices")
axes.plot(numbers, numbers, "-", label="Courant: n")
axes.plot(numbers, 0.691 * numbers, "--", label="Pleijel: .69 n")
axes.set(xlabel="number n of the mode", ylabel="nodal domains")
axes.legend()
modes = sx.eigenpairs(bodies[1], 31)
pictures = [
    sx.plot(
        bodies[1], modes.vectors[:, k], contours=[0.0], label=f"mode {k + 1}, {counts[1, k - 1]:.0f} domains", width=500
    )
    for k in (9, 19, 30)
]
