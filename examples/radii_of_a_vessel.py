"""How thick and how long are the branches of a vessel that forks, and how do they leave as a file of neurons and vessels?"""

from pathlib import Path

import numpy as np
from skimage.measure import marching_cubes

import surfexp as sx

# %%
# A vessel that forks is made of three tubes of known radii, as a volume from which its surface is cut.
tubes = {0.30: (0.0, 0.0, -1.2), 0.20: (0.9, 0.0, 1.1), 0.25: (-0.9, 0.0, 1.1)}  # radius: end of a tube from the origin
points = np.stack(np.meshgrid(*[np.arange(-1.6, 1.61, 0.05)] * 3, indexing="ij"), axis=-1)
inside = np.full(points.shape[:3], -np.inf)
for radius, end in tubes.items():
    share = np.clip(points @ end / np.dot(end, end), 0.0, 1.0)[..., None]
    inside = np.maximum(inside, radius - np.linalg.norm(points - share * end, axis=-1))
vertices, faces, _, _ = marching_cubes(inside, 0.0, allow_degenerate=False)
vessel = sx.Surface((0.05 * vertices - 1.6, faces[:, ::-1]), unit="mm")

# %%
# The Reeb graph of the distance from the lowest point has a node at the fork and an arc for each branch.
root = int(np.argmin(vessel.vertices[:, 2]))
skeleton = sx.reeb_graph(vessel, sx.geodesic(vessel, root), count=40, persistence=0.05)
table = skeleton.branches()
for k, length in enumerate(table["length"]):
    print(f"{table['from'][k]} to {table['to'][k]}: {length:.2f} mm long, radius {table['radius'][k]:.3f} mm")
print(f"made with {', '.join(f'{radius:.2f}' for radius in tubes)} mm; loops: {skeleton.metrics['b1']:.0f}")

# %%
# A tree leaves as SWC, which programs for neurons and vessels read; the unit of the vessel stands in its head.
sx.write("vessel.swc", skeleton, vessel)
print("\n".join(Path("vessel.swc").read_text().splitlines()[:4]))
sx.plot(vessel, skeleton=skeleton, views="front", width=500).save("vessel.png")
