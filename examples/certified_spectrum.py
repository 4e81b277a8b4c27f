"""Are these the 300 lowest Laplace-Beltrami eigenvalues of a sphere, or is one missing?"""

import surfexp as sx

sphere = sx.shape("icosphere", levels=4)
modes = sx.eigenpairs(sphere, 300)

# %%
# A residual proves that a pair is one, not that it is among the lowest. The inertia of a factorisation counts how many
# eigenvalues lie below a number: as many were found.
for shift, count in modes.inertia:
    print(f"{count} eigenvalues below {shift:.2f}, all found: {modes.complete}")
print(f"worst residual {modes.residuals.max():.0e}, orthogonal to {modes.orthogonality:.0e}")
picture = sx.plot(sphere, modes.vectors[:, 45], label="mode 45", width=800)
