"""Modes of a body and of a bent copy of it: which are each other's counterpart, and what their order says."""

from surfexp.embedding.mode_pairs import counterparts, mode_correlations, pairs_in_order
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.operators.fem import fem
from surfexp.populations.disguise import disguise
from surfexp.spectrum.surface_spectrum import surface_spectrum

body = ellipsoid(4, (1.0, 1.3, 1.7))
copy = disguise(body, bend=1.5)
one, other = (surface_spectrum(surface, fem(surface.mesh), 31).vectors[:, 1:] for surface in (body, copy))
areas = [surface.mesh.vertex_areas for surface in (body, copy)]
true = counterparts(mode_correlations(one, other, areas[1], copy.truth.origin))
order = pairs_in_order(one, other, *areas)
right = int((order.agrees(true) & true.paired).sum())
print(f"{int(true.paired.sum())} of 30 modes have a counterpart; {right} of them by order and skewness")
