"""Can the area and the length of the boundary of a round plate be heard in its eigenvalues?"""

import matplotlib.pyplot as plt
import numpy as np

import surfexp as sx

# %%
# Kac (1966): the sum of exp(-lambda t) over all eigenvalues of a plate with a held boundary begins, for small t, with
# A / (4 pi t) - L / (8 sqrt(pi t)) + 1/6. 200 eigenvalues know the sum where exp(-lambda t) of the last one is small.
plate = sx.shape("disk", rings=70)
modes = sx.eigenpairs(plate, 200, boundary="dirichlet")
times = np.linspace(9.0, 60.0, 60) / modes.values[-1]
trace = 4.0 * np.pi * times * np.exp(-np.outer(times, modes.values)).sum(axis=1)
terms = np.column_stack([np.ones(len(times)), -np.sqrt(times), 4.0 * np.pi / 6.0 * times])
heard = np.linalg.lstsq(terms[:, :2], trace - terms[:, 2], rcond=None)[0]
area, length = heard[0], 2.0 * heard[1] / np.sqrt(np.pi)
print(
    f"area {area:.3f}, exactly {np.pi:.3f}; boundary {length:.3f}, exactly {2 * np.pi:.3f}; all found: {modes.complete}"
)

# %%
# Counting alone says much less: Weyl's law leaves the boundary out of the count, and is far off for the first 200.
counted = 4.0 * np.pi * np.arange(1, 201) / modes.values
print(f"by Weyl's first term and the 200th eigenvalue the area would be {counted[-1]:.3f}")
figure, axes = plt.subplots(figsize=(6, 4))
axes.plot(np.sqrt(times), trace, "o", fillstyle="none", label="heat trace of 200 eigenvalues")
small = np.linspace(0.0, times[-1], 100)
fitted = heard[0] - heard[1] * np.sqrt(small) + 4.0 * np.pi / 6.0 * small
axes.plot(np.sqrt(small), fitted, "-", label=f"begins at the area {area:.3f}, falls by the boundary {length:.3f}")
axes.plot(0.0, np.pi, "s", label="exact area")
axes.set(xlabel="square root of t", ylabel="4 pi t times the heat trace")
axes.legend()
