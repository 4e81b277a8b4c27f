"""Does ARPACK return all the lowest eigenvalues of a sphere?"""

import igl
import matplotlib.pyplot as plt
import numpy as np
from scipy.sparse.linalg import eigsh

import surfexp as sx

# %%
# The sphere has equal eigenvalues: 0, three times 2, five times 6, and so on. ARPACK is asked for 10 to 60 of them, from
# three random starts each, as most packages ask it. Every answer has residuals at rounding.
mesh = sx.shape("icosphere", levels=2).mesh
vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
stiffness, mass = -igl.cotmatrix(vertices, faces), igl.massmatrix(vertices, faces)
true = sx.eigsh(stiffness, 70, mass, sigma=-0.01, return_eigenvectors=False)
missing = {}
for count in range(10, 61):
    for seed in range(3):
        start = np.random.default_rng(seed).uniform(-1.0, 1.0, len(vertices))
        found = np.sort(eigsh(stiffness, count, mass, sigma=-0.01, v0=start, return_eigenvectors=False))
        left_out = np.searchsorted(true, found[-1] - 1e-6) - np.searchsorted(found, found[-1] - 1e-6)
        if left_out > 0:
            missing[count, seed] = np.abs(found - true[:count]).max(), int(left_out), found
print(f"{len(missing)} of 153 runs of ARPACK leave eigenvalues out")

# %%
# `sx.eigsh` is called in the same way. It counts the eigenvalues below the last one by the inertia of a factorisation, and
# returns as many. `sx.Spectrum` also counts by itself.
spectrum = sx.Spectrum(sx.shape("icosphere", levels=2))
modes = spectrum.first(64)
counted = spectrum.count_below(1.01 * modes.values[-1])
print(f"surfexp: {len(modes.values)} found, {counted} counted, complete: {modes.complete}")

# %%
# One of the wrong answers beside the right one: a group of equal eigenvalues lacks a member, and all that follow move up.
figure, axes = plt.subplots(figsize=(6, 4))
(count, seed), (_, left_out, found) = max(missing.items(), key=lambda run: run[1][0])
axes.plot(np.arange(1, count + 1), true[:count], "o", fillstyle="none", label="the lowest eigenvalues")
axes.plot(np.arange(1, count + 1), found, "x", label=f"ARPACK, {left_out} left out")
axes.set(xlabel="number of the eigenvalue", ylabel="eigenvalue")
axes.legend()
