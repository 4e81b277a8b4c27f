"""A map on an ellipsoid rebuilt from its own modes, those of the sphere, and those of shuffled edge lengths."""

from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.fem import fem
from surfexp.operators.shuffled_lengths import shuffled_lengths
from surfexp.spectrum.reconstruction import accuracy_curves, area_over_log
from surfexp.spectrum.surface_spectrum import surface_spectrum

body, ball = ellipsoid(3, (1.0, 1.4, 3.0)), icosphere(3)
operators = {"own": fem(body.mesh), "sphere": fem(ball.mesh), "shuffled": shuffled_lengths(body.mesh)}
bands = (body.mesh.vertices[:, [2]] % 1.5) ** 2
areas = {}
for name, operator in operators.items():
    basis = surface_spectrum(body, operator, 60).vectors
    areas[name] = area_over_log(accuracy_curves(basis, mass_matrix(operators["own"]), bands), 5, 60)[0]
    print(f"{name}: {areas[name]:.3f}")
