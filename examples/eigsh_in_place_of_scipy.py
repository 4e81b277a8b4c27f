"""What changes where scipy's eigsh is called on the matrices of a mesh? One name; the answer comes with a proof."""

import igl
import numpy as np

import surfexp as sx

# %%
# Any stiffness and mass matrix will do; these are libigl's.
mesh = sx.shape("icosphere", levels=4).mesh
vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
stiffness, mass = -igl.cotmatrix(vertices, faces), igl.massmatrix(vertices, faces)

# %%
# Only the name of the function differs from scipy's. It fails rather than to leave an eigenvalue out.
values, vectors = sx.eigsh(stiffness, 9, mass, sigma=-0.01)
exact = np.array([0, 2, 2, 2, 6, 6, 6, 6, 6])
print(f"{len(values)} eigenvalues, largest error {np.abs(values - exact).max():.3f} of {exact.max()}")
print(f"orthonormal to {np.abs(vectors.T @ mass @ vectors - np.eye(9)).max():.0e}")
picture = sx.plot((vertices, faces), vectors[:, 6], label="mode 6", width=800)
