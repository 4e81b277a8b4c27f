"""The 300 lowest Laplace-Beltrami eigenvalues of a sphere, with the proof that none is missing."""

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs

elements = surface_elements(icosphere(4).mesh)
system = eigenpairs(elements.stiffness, elements.mass, k=300)
for shift, count in system.inertia:
    print(f"{count} eigenvalues below {shift:.2f}, all found: {system.complete}")
print(f"worst residual {system.residuals.max():.0e}, orthogonal to {system.orthogonality:.0e}")
