"""How published iterations are judged: by the change of iterates, and the last one by its gap to the full model."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.published.consistent_audit import run_and_audit
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solvers.primal_dual import primal_dual


def test_changes_are_relative_and_the_last_iterate_is_audited(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    fidelity = rof(operator.mass, image.values, 0.9 / (40.0 * operator.edge_length))
    best = primal_dual(fidelity, operator, tolerance=1e-6)
    size = np.sqrt(operator.mass @ best.values**2)
    states = [(k, best.values * factor) for k, factor in enumerate((0.5, 0.8, 1.0, 1.0 + 1e-6, 7.0), 1)]
    seen: list[tuple[int, float]] = []
    done = run_and_audit(states, fidelity, operator, "rule", None, lambda *row: seen.append(row))
    expected = [1.0, 0.3 / 0.8, 0.2, 1e-6 / (1.0 + 1e-6)]
    np.testing.assert_allclose(done.history["change"], expected, rtol=1e-6)
    assert seen == list(zip((1, 2, 3, 4), done.history["change"], strict=True))
    assert done.converged and done.iterations == 4 and "relative change" in done.reason
    assert np.array_equal(done.values, states[3][1]) and size > 0
    assert done.energy >= best.lower_bound and done.relative_gap == pytest.approx(best.relative_gap, abs=1e-5)
    short = run_and_audit(states[:2], fidelity, operator, "rule", 0.1)
    assert not short.converged and short.reason == "iteration limit" and short.relative_gap > 0.01
    with pytest.raises(ValueError, match="iteration_limit is 0"):
        run_and_audit([], fidelity, operator, "rule", None)
