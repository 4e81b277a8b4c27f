"""Area and Euler characteristic of a torus, heard in its first 1,000 eigenvalues."""

import numpy as np

from surfexp.spectrum.heat_trace import hear_geometry

squares = np.arange(-30, 31) ** 2
values = np.sort(np.add.outer(squares, squares).ravel())[:1000].astype(float)
heard = hear_geometry(values)
print(f"area {heard.area:.6f} (exact {4 * np.pi**2:.6f}), Euler characteristic {heard.euler_characteristic:.4f}")
