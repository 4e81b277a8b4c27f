"""Newton's systems against dense solutions, and refusals."""

import numpy as np
import pytest

from surfexp.mesh.surface import Surface
from surfexp.operators.assembly import assemble
from surfexp.operators.fem import fem
from surfexp.variational.solvers.newton_system import NewtonSystem


def test_solves_one_matrix_after_another(surface: Surface) -> None:
    operator, random = fem(surface.mesh), np.random.default_rng(0)
    weight = random.uniform(0.1, 1.0, operator.vertex_count)
    system = NewtonSystem(operator, weight)
    for _ in range(2):
        roots = random.normal(size=(len(operator.faces), 3, 2)) * 10.0 ** random.uniform(
            -3, 3, (len(operator.faces), 1, 1)
        )
        local = roots @ roots.transpose(0, 2, 1)
        system.refactor(local)
        matrix = assemble(operator.faces, local, operator.vertex_count).toarray() + np.diag(weight)
        given = random.normal(size=operator.vertex_count)
        solution = np.linalg.solve(matrix, given)
        assert np.abs(system.solve(given) - solution).max() <= 1e-8 * np.abs(solution).max()


def test_a_matrix_that_is_not_finite_is_refused(surface: Surface) -> None:
    operator = fem(surface.mesh)
    system = NewtonSystem(operator, operator.mass)
    local = np.zeros((len(operator.faces), 3, 3))
    local[7] = np.nan
    system.refactor(local)
    with pytest.raises(ValueError, match="at most 1e-08 is accepted"):
        system.solve(np.ones(operator.vertex_count))
