"""The automatic choice takes what promises the least error, whatever the unit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.smoothing.automatic import CANDIDATES, AutomaticSmoothing, automatic_smoothing
from surfexp.smoothing.methods import MethodName, Methods
from surfexp.tasks import automatic_denoising
from surfexp.tasks.denoising import denoise

BALL = icosphere(3).mesh
OPERATOR = fem(BALL)
X = BALL.vertices[:, 0]


def smoothed(truth: Floats) -> AutomaticSmoothing:
    return automatic_smoothing(BALL, OPERATOR, truth + np.random.default_rng(0).standard_normal(len(truth)))


def test_borders_take_total_variation_and_slopes_a_gaussian() -> None:
    border = smoothed(4.0 * (X > 0))
    slope = smoothed(np.sin(3.0 * X))
    assert border.method in ("total_variation", "edge_weighted_variation") and border.converged
    assert slope.method == "heat_polynomial"


@pytest.mark.parametrize("border", [True, False])
def test_what_is_chosen_is_nearly_the_best_candidate(border: bool) -> None:
    mesh = icosphere(4).mesh
    operator, x = fem(mesh), mesh.vertices[:, 0]
    truth = 3.0 * (x > 0) if border else np.sin(2.0 * x)
    rough = truth + np.random.default_rng(1).standard_normal(len(x))
    each = {name: automatic_smoothing(mesh, operator, rough, candidates=(name,)) for name in CANDIDATES}
    found = automatic_smoothing(mesh, operator, rough)
    squares = {name: operator.mass @ (one.values - truth) ** 2 / operator.mass.sum() for name, one in each.items()}
    assert found.risk == {name: one.risk[name] for name, one in each.items()}
    assert found.method == min(found.risk, key=lambda name: found.risk[name])
    assert squares[found.method] < 1.2 * min(squares.values())
    # 2,562 values of variance 1: the estimate has a deviation of .03
    assert all(abs(found.risk[name] - squares[name]) < 4.0 * np.sqrt(2.0 / len(x)) for name in CANDIDATES)


def test_the_choice_does_not_depend_on_the_units() -> None:
    rough = 2.0 * (X > 0) + np.random.default_rng(0).standard_normal(len(X))
    small = automatic_smoothing(BALL, OPERATOR, rough)
    large = TriangleMesh(50.0 * BALL.vertices, BALL.faces)
    other = automatic_smoothing(large, fem(large), 10.0 * rough)
    assert other.method == small.method
    assert other.values == pytest.approx(10.0 * small.values, abs=1e-2)
    only = ("heat_polynomial",)
    widths = [automatic_smoothing(mesh, fem(mesh), rough, candidates=only).parameter for mesh in (BALL, large)]
    assert widths[1] == pytest.approx(50.0 * widths[0])


@pytest.mark.parametrize("size", [1.0, 50.0])
@pytest.mark.parametrize("name", ["total_variation", "heat_polynomial"])
def test_the_parameter_that_is_reported_gives_the_map_again(size: float, name: MethodName) -> None:
    """A weight has no unit and a width has that of the surface, whatever its size: its own method repeats the result."""
    mesh = TriangleMesh(size * BALL.vertices, BALL.faces)
    rough = 2.0 * (X > 0) + np.random.default_rng(0).standard_normal(len(X))
    found = automatic_smoothing(mesh, fem(mesh), rough, candidates=(name,))
    smoother, _ = Methods(mesh, fem(mesh), found.noise).smoother(name)
    assert smoother(rough[:, None], found.parameter)[:, 0] == pytest.approx(found.values, abs=1e-6)


@pytest.mark.parametrize("border", [True, False])
def test_outliers_are_replaced_and_listed_and_cost_nearly_nothing(border: bool) -> None:
    mesh = icosphere(4).mesh
    operator, x = fem(mesh), mesh.vertices[:, 0]
    rng = np.random.default_rng(3)
    truth = 3.0 * (x > 0.2) if border else np.sin(3.0 * x)
    white = truth + 0.3 * truth.std() * rng.standard_normal(len(x))
    bad = np.sort(rng.choice(len(x), len(x) // 50, replace=False))
    rough = white.copy()
    rough[bad] += 6.0 * truth.std() * rng.choice([-1.0, 1.0], len(bad))
    found = denoise(Surface(mesh), rough, method="auto")

    def error(values: Floats) -> float:
        return float(np.sqrt(operator.mass @ (values - truth) ** 2 / operator.mass.sum()))

    assert np.array_equal(found.outliers, bad) and found.certificate["outliers"] == len(bad)
    assert [note for note in found.notes if "outliers" in note] == [
        f"{len(bad)} of {len(x)} values are far from those of all their neighbours and were replaced by the median of these: "
        "`outliers` lists them."
    ]
    assert error(found.values) < 1.1 * error(denoise(Surface(mesh), white, method="auto").values)
    # what named methods do with them is said
    followed = denoise(Surface(mesh), rough, method="rof")
    assert len(followed.outliers) == 0 and any("method auto replaces them" in note for note in followed.notes)


def test_it_refuses_what_it_cannot_do() -> None:
    with pytest.raises(ValueError, match="there are 0 candidates"):
        automatic_smoothing(BALL, OPERATOR, X, candidates=())
    with pytest.raises(ValueError, match="noise"):
        automatic_smoothing(BALL, OPERATOR, X, noise=0.0)


@pytest.mark.parametrize("at_the_end", [False, True])
def test_an_end_of_the_grid_is_said(at_the_end: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    plain = automatic_denoising.fitted_smoothing(OPERATOR, X, 0.1)
    members = tuple(replace(one, at_the_end=at_the_end) for one in plain.mixture.members)
    found = replace(plain, mixture=replace(plain.mixture, members=members))
    monkeypatch.setattr(automatic_denoising, "fitted_smoothing", lambda *_: found)
    result = denoise(Surface(BALL), X, method="auto")
    assert any("an end of its grid" in note for note in result.notes) == at_the_end
    assert np.array_equal(result.values, found.mixture.values)


def test_a_tolerance_that_is_given_holds_for_several_channels_too() -> None:
    ball = icosphere(2)
    values = ball.mesh.vertices[:, :2] + 0.1 * np.random.default_rng(0).standard_normal((162, 2))
    asked = {tolerance: denoise(ball, values, tolerance=tolerance).evidence for tolerance in (1e-2, 1e-5, None)}
    assert [proof.tolerance for proof in asked.values() if proof] == [1e-2, 1e-5, 1e-4]
