"""The cameraman on a cup with a handle, with noise of 40 grey levels."""

import numpy as np

from surfexp.mesh.shapes.cup import cup
from surfexp.variational.images.painting import add_noise, paint
from surfexp.variational.images.pictures import picture

surface = cup(4000)
image = paint(surface, picture("cameraman"), "cylindrical")
noisy = add_noise(image, 40.0, seed=1)
rmse = np.sqrt(np.average((noisy.values - image.values) ** 2, weights=surface.mesh.vertex_areas))
print(f"genus {surface.mesh.genus}, minimum angle {surface.mesh.minimum_angle:.0f} degrees, noise {rmse:.1f} of 255")
