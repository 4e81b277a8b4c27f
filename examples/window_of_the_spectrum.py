"""Which eigenvalues of a torus lie between 20 and 30, and is any missing?"""

import surfexp as sx

# %%
# All eigenpairs between two numbers, without those below. Counts by inertia at both ends prove that none is missing.
spectrum = sx.Spectrum(sx.shape("torus", n_u=90, n_v=36))
window = spectrum.between(20.0, 30.0)
counted = spectrum.count_below(30.0) - spectrum.count_below(20.0)
print(f"{len(window.values)} found, {counted} counted, all found: {window.complete}")
print(f"from {window.values[0]:.4f} to {window.values[-1]:.4f}, largest residual {window.residuals.max():.0e}")
picture = sx.plot(spectrum.surface, window.vectors[:, 0], label="first in the window", width=800)
