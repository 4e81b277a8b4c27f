"""Loops over faces against the same formulas written with arrays, and Newton's moves against the equations that they solve."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.variational.separable_quadratic import convex_chan_vese
from surfexp.variational.simplex_labelling import SimplexLabelling
from surfexp.variational.solvers.cone_newton import complementarity, face_moves, residual_fields
from surfexp.variational.solvers.face_sweeps import (
    bregman_update,
    chambolle_step,
    dual_ascent,
    face_steps,
    fista_step,
    smoothed_normals,
)
from surfexp.variational.solvers.threaded_ascent import ThreadedAscent

CHANNELS = 2


class Faces:
    """Random fields on a torus, and gradient and load as plain sums."""

    def __init__(self, surface: Surface):
        self.operator = fem(surface.mesh)
        self.hats, self.areas, self.faces = self.operator.hat_gradients, self.operator.areas, self.operator.faces
        self.random = np.random.default_rng(3)
        self.steps = face_steps(self.hats)
        self.values = self.random.normal(size=(self.operator.vertex_count, CHANNELS))
        self.dual, self.other = (self.random.normal(size=(len(self.faces), CHANNELS, 2)) for _ in range(2))
        # what a sweep finds there must not matter
        self.load = self.random.normal(size=self.values.shape)
        self.geometry = (self.faces, self.hats, self.areas)

    @property
    def gradient(self) -> np.ndarray:
        return np.einsum("fkd,fkc->fcd", self.hats, self.values[self.faces])

    def load_of(self, field: np.ndarray) -> np.ndarray:
        result = np.zeros_like(self.values)
        np.add.at(result, self.faces, np.einsum("f,fkd,fcd->fkc", self.areas, self.hats, field))
        return result


def in_ball(field: np.ndarray) -> np.ndarray:
    return field / np.maximum(np.linalg.norm(field, axis=(1, 2)), 1.0)[:, None, None]


@pytest.fixture
def fields(surface: Surface) -> Faces:
    return Faces(surface)


def test_steps_are_those_of_the_largest_eigenvalue(fields: Faces) -> None:
    matrices = np.einsum("fka,fkb->fab", fields.hats, fields.hats)
    assert fields.steps == pytest.approx(1.0 / (3.0 * np.linalg.eigvalsh(matrices)[:, -1]))


def test_projected_ascent(fields: Faces) -> None:
    expected = in_ball(fields.dual + 0.7 * fields.steps[:, None, None] * fields.gradient)
    dual_ascent(*fields.geometry, fields.steps, 0.7, fields.values, fields.dual, fields.load)
    assert fields.dual == pytest.approx(expected, abs=1e-12)
    assert fields.load == pytest.approx(fields.load_of(expected), abs=1e-10)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_loads_of_threads_are_added(fields: Faces, threads: int) -> None:
    ascent = ThreadedAscent(fields.operator, CHANNELS, threads)
    expected = in_ball(fields.dual + 0.7 * fields.steps[:, None, None] * fields.gradient)
    ascent(0.7, fields.values, fields.dual, fields.load)
    ascent.close()
    assert fields.dual == pytest.approx(expected, abs=1e-12)
    assert fields.load == pytest.approx(fields.load_of(expected), abs=1e-10)


def test_chambolle_step(fields: Faces) -> None:
    ascent = 0.7 * fields.steps[:, None, None]
    shrink = 1.0 + ascent * np.linalg.norm(fields.gradient, axis=(1, 2))[:, None, None]
    expected = (fields.dual + ascent * fields.gradient) / shrink
    chambolle_step(*fields.geometry, fields.steps, 0.7, fields.values, fields.dual, fields.load)
    assert fields.dual == pytest.approx(expected, abs=1e-12)
    assert fields.load == pytest.approx(fields.load_of(expected), abs=1e-10)


def test_accelerated_step(fields: Faces) -> None:
    before, ahead = fields.dual.copy(), fields.other.copy()
    expected = in_ball(ahead + 0.7 * fields.steps[:, None, None] * fields.gradient)
    further = expected + 0.4 * (expected - before)
    weights = fields.areas / fields.steps
    turn = np.einsum("f,fcd,fcd->", weights, ahead - expected, expected - before)
    found = fista_step(*fields.geometry, fields.steps, 0.7, 0.4, fields.values, fields.dual, fields.other, fields.load)
    assert fields.dual == pytest.approx(expected, abs=1e-12) and fields.other == pytest.approx(further, abs=1e-12)
    assert fields.load == pytest.approx(fields.load_of(further), abs=1e-10)
    assert found == pytest.approx(turn, rel=1e-10)


def test_bregman_update(fields: Faces) -> None:
    penalty, relaxation = 2.5, 1.6
    field, multiplier, pull = fields.dual, fields.other, fields.random.normal(size=fields.values.shape)
    mixed = relaxation * fields.gradient + (1.0 - relaxation) * field + multiplier
    ball = in_ball(penalty * mixed) / penalty
    bregman_update(*fields.geometry, penalty, relaxation, fields.values, field, multiplier, fields.load, pull)
    assert multiplier == pytest.approx(ball, abs=1e-12) and field == pytest.approx(mixed - ball, abs=1e-12)
    assert fields.load == pytest.approx(fields.load_of(penalty * ball), abs=1e-10)
    assert pull == pytest.approx(fields.load_of(mixed - 2.0 * ball), abs=1e-10)


def test_smoothed_normals(fields: Faces) -> None:
    lengths = np.sqrt((fields.gradient**2).sum(axis=(1, 2)) + 0.3**2)
    smoothed_normals(*fields.geometry, 0.3, fields.values, fields.dual, fields.load)
    assert fields.dual == pytest.approx(fields.gradient / lengths[:, None, None], abs=1e-12)
    assert fields.load == pytest.approx(fields.load_of(fields.gradient / lengths[:, None, None]), abs=1e-10)


def test_newton_moves_solve_the_linearised_equations_and_stop_at_the_cones() -> None:
    random, count, nu = np.random.default_rng(1), 200, 0.3
    grad, dual = random.normal(size=(count, 2)), random.uniform(-0.6, 0.6, (count, 2))
    slack = np.linalg.norm(grad, axis=1) + random.uniform(0.1, 1.0, count)
    moves = random.normal(size=count), random.normal(size=(count, 2)), random.normal(size=(count, 2))
    base, rest = residual_fields(nu, slack, grad, dual, moves)
    # t - u . p = nu and t p = u, with the second-order terms of the round before, while u stays
    scalar = nu - slack + (grad * dual).sum(axis=1) + (moves[1] * moves[2]).sum(axis=1)
    vector = slack[:, None] * dual - grad + moves[0][:, None] * moves[2]
    assert rest - (grad * base).sum(axis=1) == pytest.approx(scalar, abs=1e-12)
    assert slack[:, None] * base + dual * rest[:, None] == pytest.approx(-vector, abs=1e-12)
    change = random.normal(size=(count, 2))
    blocks = random.normal(size=(count, 3))
    slack_move, dual_move, cone_step, ball_step = face_moves(slack, grad, dual, blocks, change, base, rest)
    # the move of p that the equations ask for, of which C holds the symmetric part only
    exact = (change - dual * slack_move[:, None] - vector) / slack[:, None]
    assert slack_move - (grad * exact).sum(axis=1) - (dual * change).sum(axis=1) == pytest.approx(scalar, abs=1e-11)
    matrices = blocks[:, [0, 1, 1, 2]].reshape(-1, 2, 2)
    assert dual_move == pytest.approx(base + np.einsum("fab,fb->fa", matrices, change), abs=1e-12)
    at = slack + cone_step * slack_move - np.linalg.norm(grad + cone_step * change, axis=1)
    assert abs(at.min()) < 1e-9
    assert np.linalg.norm(dual + ball_step * dual_move, axis=1).max() == pytest.approx(1.0, abs=1e-9)
    weights = random.uniform(0.5, 2.0, count)
    assert complementarity(weights, slack, grad, dual) == pytest.approx(
        np.average(slack - (grad * dual).sum(axis=1), weights=weights)
    )


def test_the_gap_is_scaled_by_the_spread_down_from_the_best_trivial_labelling() -> None:
    mass, slope = np.array([1.0, 2.0, 3.0]), np.array([4.0, -1.0, -2.0])
    for given, best in ((np.inf, -4.0), (-7.5, -7.5)):
        fidelity = convex_chan_vese(mass, slope, given)
        assert fidelity.gap_scale(0.0, -10.0) == best + 10.0
        # where nothing is to be gained, 1e-4 of the integral of |r|
        assert fidelity.gap_scale(0.0, best) == pytest.approx(1e-4 * (mass @ np.abs(slope)))
    costs = np.array([[0.0, 1.0], [2.0, 1.0], [5.0, 3.0]])
    for given, best in ((np.inf, 12.0), (11.0, 11.0), (30.0, 12.0)):
        labelling = SimplexLabelling(mass, costs, given)
        assert labelling.trivial == best and labelling.gap_scale(0.0, 4.0) == best - 4.0
