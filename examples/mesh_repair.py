"""What is wrong with a file in which faces are turned over and a fin is glued to an edge, and can it be repaired?"""

import numpy as np

import surfexp as sx

# %%
# A sphere on which ten faces are turned over, and a fin is glued to an edge.
sphere = sx.shape("icosphere", levels=3).mesh
faces = np.vstack([sphere.faces, [*sphere.faces[0][:2], len(sphere.vertices)]])
faces[:10] = faces[:10, ::-1]
np.savez("fin.npz", vertices=np.vstack([sphere.vertices, [[2.0, 2.0, 2.0]]]), faces=faces)

# %%
# Reading refuses it and names each defect; with `repair=True` it is repaired, and each change is named.
try:
    sx.read("fin.npz")
except ValueError as refused:
    print(refused)
mesh = (repaired := sx.read("fin.npz", repair=True)).mesh
print("\n".join(repaired.notes))
print(f"genus {mesh.genus}, {len(mesh.vertices)} vertices, area error {abs(mesh.area - sphere.area):.1e}")
picture = sx.plot(repaired, width=800)
