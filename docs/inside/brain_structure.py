"""The caudate of a subject as a closed surface, and the proof that its spectrum is complete."""

import surfexp as sx
from surfexp.anatomy.subcortical import subcortical_surface

surface = subcortical_surface("9861", "caudate", "left", vertices=1500)
system = sx.eigenpairs(surface, 20)
print(f"genus {surface.mesh.genus}, {surface.mesh.area:.0f} mm2, volume lost {surface.metrics['volume_loss']:.2f}")
print(f"first eigenvalue {system.values[1]:.5f} / mm2, complete: {system.complete}")
