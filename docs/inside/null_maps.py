"""Two smooth maps that have nothing in common: their correlation by Student's test, and against three kinds of null maps."""

import surfexp as sx
from surfexp.nulls.eigenstrapping import eigenstrapped
from surfexp.nulls.fields import gaussian_fields
from surfexp.nulls.neighbourhoods import nearest_along_surface
from surfexp.nulls.rejection import correlations, p_values, parametric_p_values
from surfexp.nulls.spins import random_rotations, spin_sources, spun
from surfexp.nulls.variogram import variogram_pairs
from surfexp.nulls.variogram_matching import VariogramMatching
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.fem import fem

ball = sx.shape("icosphere", levels=3)
operator = fem(ball.mesh)
values, other = gaussian_fields(operator, 1.0, 2, seed=1).T[:, :, None]
modes, pairs = sx.eigenpairs(ball, 64).vectors, variogram_pairs(ball.mesh, reach=1.5)
kernels = VariogramMatching(*nearest_along_surface(ball.mesh, 300), pairs, (0.05, 0.1, 0.2, 0.4, 0.8))
nulls = {
    "eigenstrapping": eigenstrapped(modes, mass_matrix(operator), values[:, 0], 199),
    "spins": spun(values[:, 0], spin_sources(ball.mesh.vertices, random_rotations(199))),
    "variogram": kernels.nulls(values[:, 0], 199),
}
observed = correlations(values, other)[0]
naive = parametric_p_values(observed, len(values))[0]
print(f"correlation {observed[0]:.2f}; independent vertices: p = {naive:.1g}")
for name, maps in nulls.items():
    p = p_values(observed, correlations(maps, other))[0]
    print(f"{name}: p = {p:.3f}")
    assert naive < 0.01 < 0.05 < p  # noqa: S101
