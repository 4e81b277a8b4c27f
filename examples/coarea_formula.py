"""Is the total variation of a map the length of all its level lines, and what does noise add to it?"""

import numpy as np

import surfexp as sx

# %%
# On the unit sphere the height has the total variation pi squared: its level line at z is a circle of length
# 2 pi sqrt(1 - z^2), and these lengths are integrated over z from -1 to 1. A mesh gives both sides of this co-area
# formula: the gradients of its faces, and the lines along which the levels cut them.


def total_variation(surface, values):
    corners = surface.vertices[surface.faces]
    opposite = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    return 0.5 * np.linalg.norm((values[surface.faces][:, :, None] * opposite).sum(axis=1), axis=1).sum()


def length_of_level(surface, values, level):
    start, above = surface.vertices[surface.faces], values[surface.faces] - level
    end, beyond = np.roll(start, -1, axis=1), np.roll(above, -1, axis=1)
    cut = above * beyond < 0.0
    share = above[cut] / (above[cut] - beyond[cut])
    points = start[cut] + share[:, None] * (end[cut] - start[cut])
    return np.linalg.norm(np.diff(points.reshape(-1, 2, 3), axis=1), axis=2).sum()


heights = (np.arange(400) + 0.5) / 200.0 - 1.0
for levels in (2, 3, 4, 5):
    sphere = sx.shape("icosphere", levels=levels)
    z = sphere.vertices[:, 2]
    lines = np.mean([length_of_level(sphere, z, height) for height in heights]) * 2.0
    print(f"{len(z)} vertices: variation {total_variation(sphere, z):.4f}, lines {lines:.4f}, exactly {np.pi**2:.4f}")

# %%
# Noise makes level lines longer, which is why total variation finds it. Denoising takes the length away again.
noisy = z + np.random.default_rng(0).normal(0.0, 0.2, len(z))
clean = sx.denoise(sphere, noisy)
before, after = total_variation(sphere, noisy), total_variation(sphere, clean.values)
print(f"with noise {before:.1f}, denoised {after:.1f}, root-mean-square error {np.std(clean.values - z):.3f}")
maps = {"with noise": noisy, "denoised": clean.values}
pictures = [
    sx.plot(sphere, field, contours=np.linspace(-0.75, 0.75, 7), limits=(-1, 1), label=name, width=500)
    for name, field in maps.items()
]
