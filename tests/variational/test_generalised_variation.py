"""Total generalised variation: what costs nothing, what it lies between, an exact solution, two solvers, a referee."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.operators.vertex_averaged import vertex_averaged
from surfexp.variational.generalised_forms import GeneralisedForms
from surfexp.variational.generalised_variation import GeneralisedVariation, lengths
from surfexp.variational.image import Image
from surfexp.variational.models.rof import ROF
from surfexp.variational.models.tgv import TGV
from surfexp.variational.separable_quadratic import convex_chan_vese, rof
from surfexp.variational.solvers import generalised_splitting as splitting
from surfexp.variational.solvers.generalised_primal_dual import generalised_primal_dual
from surfexp.variational.solvers.generalised_splitting import generalised_splitting
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual

from . import independent_certificate as independent


def noisy(levels: int = 3, ratio: float = 2.0) -> GeneralisedVariation:
    """A slope and a step on the sphere, with noise."""
    mesh, rng = icosphere(levels).mesh, np.random.default_rng(0)
    operator, points = fem(mesh), mesh.vertices
    values = 100 * points[:, 2] + 100 * (points[:, 0] > 0.2) + 20 * rng.standard_normal(len(points))
    h = operator.edge_length
    return GeneralisedVariation(rof(operator.mass, values, 0.9 / (20 * h)), operator, ratio * h)


def strip(n: int) -> TriangleMesh:
    """The rectangle [-1, 1] x [0, 1/2] with 2 n faces along its length, inner vertices moved at random."""
    flat, rng = rectangle(2 * n + 1, n // 2 + 1, 2.0, 0.5).mesh, np.random.default_rng(0)
    x, y, _ = flat.vertices.T
    inside = (x > 0) & (x < 2) & (y > 0) & (y < 0.5)
    shift = inside[:, None] * rng.uniform(-0.25, 0.25, flat.vertices.shape) / n * [1, 1, 0]
    return TriangleMesh(flat.vertices + shift - [1, 0, 0], flat.faces)


@pytest.mark.slow
@given(st.integers(0, 2**31))
def test_linear_images_of_a_plane_cost_nothing_and_stay(seed: int) -> None:
    mesh, rng = strip(6), np.random.default_rng(seed)
    values = mesh.vertices @ rng.standard_normal(3) + rng.standard_normal()
    operator = fem(mesh)
    problem = GeneralisedVariation(rof(operator.mass, values, 3.0), operator, 0.3)
    found = generalised_splitting(problem).solution
    assert found.converged and found.energy <= 1e-10
    np.testing.assert_allclose(found.values, values, atol=1e-9)


def test_the_certificate_again_by_other_means() -> None:
    """Energies from gradients in space; p and q balance against any field w, so that w may be anything in the bound."""
    problem = noisy()
    found = generalised_splitting(problem, tolerance=1e-5)
    solution, operator, fields = found.solution, problem.operator, problem.fields
    assert solution.converged and solution.relative_gap <= 1e-5
    p, q = solution.dual[:, 0], solution.dual[:, 1:] * problem.ratio
    assert np.linalg.norm(q, axis=(1, 2)).max() <= problem.ratio * (1 + 1e-12)
    mesh, image, mu = icosphere(3).mesh, problem.fidelity.target, problem.fidelity.strong_convexity
    load, mass = independent.load_of(mesh, operator, p), independent.lumped(mesh)
    bound = float(image @ load - load @ (load / mass) / (2 * mu))
    slope_means = (fields.averages @ found.slopes.ravel()).reshape(-1, 2)
    gradients = np.einsum("fkx,fk->fx", independent.face_weights(mesh), solution.values[mesh.faces])
    rest = gradients - np.einsum("fa,fax->fx", slope_means, operator.frames)
    turns = np.linalg.norm((fields.derivative @ found.slopes.ravel()).reshape(-1, 4), axis=1)
    areas = independent.heron_areas(mesh)
    energy = areas @ (np.linalg.norm(rest, axis=1) + problem.ratio * turns)
    independent.check(solution, energy + 0.5 * mu * mass @ (solution.values - image) ** 2, bound)
    for seed in range(5):
        w = np.random.default_rng(seed).standard_normal(2 * len(fields.edges))
        first = areas @ (p * (fields.averages @ w).reshape(-1, 2)).sum(axis=1)
        second = areas @ (q.reshape(-1, 4) * (fields.derivative @ w).reshape(-1, 4)).sum(axis=1)
        assert first == pytest.approx(second, rel=1e-8)


@given(st.integers(0, 2**31), st.floats(0.0, 3.0))
def test_no_field_has_less_energy_than_the_bound_of_any_dual(seed: int, size: float) -> None:
    problem, rng = noisy(1), np.random.default_rng(seed)
    dual = problem.feasible(rng.standard_normal(problem.forms.shape[0]) * size)
    assert max(part.max() for part in lengths(dual)) <= 1.0 + 1e-12
    unknowns = rng.standard_normal(problem.forms.shape[1]) * 10.0**size
    certificate = problem.certify(unknowns, dual)
    assert np.isfinite(certificate.lower_bound) and certificate.energy >= certificate.lower_bound


def test_a_field_out_of_balance_or_too_long_proves_nothing() -> None:
    problem = noisy(1)
    unknowns, dual = np.zeros(problem.forms.shape[1]), np.zeros(problem.forms.shape[0])
    sound = problem.feasible(problem.forms @ np.random.default_rng(0).standard_normal(problem.forms.shape[1]))
    assert np.isfinite(problem.certify(unknowns, sound).lower_bound)
    assert problem.certify(unknowns, 1.01 * sound).lower_bound == -np.inf
    dual[0] = 0.5
    assert problem.certify(unknowns, dual).lower_bound == -np.inf
    dual[0] = 1e-6
    assert problem.certify(unknowns, 0.9 * sound + dual).lower_bound == -np.inf


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e4])
def test_balance_has_no_unit(size: float) -> None:
    mesh, rng = icosphere(1).mesh, np.random.default_rng(0)
    operator = fem(TriangleMesh(size * mesh.vertices, mesh.faces))
    problem = GeneralisedVariation(rof(operator.mass, rng.standard_normal(42), 1.0 / size), operator, 0.5 * size)
    dual = problem.feasible(rng.standard_normal(problem.forms.shape[0]))
    assert np.isfinite(problem.certify(np.zeros(problem.forms.shape[1]), dual).lower_bound)


def test_the_gap_is_relative_to_the_energy_however_small() -> None:
    mesh, rng = strip(6), np.random.default_rng(0)
    values = mesh.vertices[:, 0] + 1e-3 * rng.standard_normal(len(mesh.vertices))
    operator = fem(mesh)
    problem = GeneralisedVariation(rof(operator.mass, values, 3.0), operator, 0.3)
    found = generalised_splitting(problem, tolerance=1e-3).solution
    constant = problem.fidelity.value(np.full(len(values), values.mean()))
    assert 1e-7 * constant < found.energy < 3e-3 * constant
    assert found.relative_gap == pytest.approx((found.energy - found.lower_bound) / found.energy, rel=1e-9)


def test_two_solvers_agree_within_what_they_prove() -> None:
    problem = noisy()
    first = generalised_splitting(problem, tolerance=1e-5).solution
    second = generalised_primal_dual(problem, tolerance=1e-4).solution
    assert first.converged and second.converged
    assert max(first.lower_bound, second.lower_bound) <= min(first.energy, second.energy)
    apart = np.sqrt(problem.operator.mass @ (first.values - second.values) ** 2)
    assert apart <= first.error_bound + second.error_bound
    assert np.all(np.diff(first.history["iteration"]) > 0) and first.history["gap"][-1] == first.relative_gap


@pytest.mark.optional
def test_an_interior_point_solver_agrees() -> None:
    cp = pytest.importorskip("cvxpy")
    problem = noisy(2)
    ours = generalised_splitting(problem, tolerance=1e-7).solution
    unknowns = cp.Variable(problem.forms.shape[1])
    rows = cp.reshape(problem.forms @ unknowns, (len(problem.operator.areas), 6), order="C")
    roots = np.sqrt(0.5 * problem.operator.mass * problem.fidelity.weight)
    data = cp.sum_squares(cp.multiply(roots, unknowns[: len(roots)] - problem.fidelity.target))
    parts = cp.norm(rows[:, :2], 2, axis=1) + cp.norm(rows[:, 2:], 2, axis=1)
    referee = cp.Problem(cp.Minimize(problem.operator.areas @ parts + data))
    referee.solve(solver=cp.CLARABEL)
    assert ours.lower_bound <= referee.value * (1 + 1e-6) and referee.value <= ours.energy * (1 + 1e-6)
    assert np.sqrt(problem.operator.mass @ (unknowns.value[: len(roots)] - ours.values) ** 2) <= 1.1 * ours.error_bound


@pytest.mark.slow
def test_it_lies_below_total_variation_and_tends_to_it_where_no_slope_is_parallel() -> None:
    """On a sphere no field is parallel: a long ratio leaves w = 0."""
    problem = noisy(ratio=2.0)
    total = newton(problem.fidelity, problem.operator).energy
    energies = [
        generalised_splitting(noisy(ratio=ratio), tolerance=1e-4).solution.energy for ratio in (0.5, 2.0, 4.0, 30.0)
    ]
    assert np.all(np.diff(energies) > 0) and energies[-1] <= total * (1 + 1e-4)
    assert energies[1] < 0.97 * total
    assert energies[-1] == pytest.approx(total, rel=2e-4)


def test_an_exact_solution_and_its_rate() -> None:
    """u = -|x| stays, for f = u + q''/mu with q = -ratio cos^2(pi x / 2): q and q' vanish at the ends, |q'| <= 1."""
    ratio, mu, errors = 0.3, 20.0, []
    for n in (8, 16, 32):
        mesh = strip(n)
        operator, x = fem(mesh), mesh.vertices[:, 0]
        exact = -np.abs(x)
        image = exact + ratio * np.pi**2 / (2 * mu) * np.cos(np.pi * x)
        found = generalised_splitting(GeneralisedVariation(rof(operator.mass, image, mu), operator, ratio)).solution
        assert found.converged
        errors.append(np.sqrt(operator.mass @ (found.values - exact) ** 2 / operator.mass.sum()))
    assert errors[0] < 0.2 * np.sqrt(np.mean((ratio * np.pi**2 / (2 * mu) * np.cos(np.pi * x)) ** 2))
    assert np.log(errors[0] / errors[-1]) / np.log(4.0) > 0.8


def test_motions_scale_and_numbering_change_nothing() -> None:
    mesh, rng = icosphere(2).mesh, np.random.default_rng(1)
    values = 100 * mesh.vertices[:, 2] + 20 * rng.standard_normal(len(mesh.vertices))
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    order = rng.permutation(len(values))
    places = np.argsort(order)
    others = {
        "moved": (TriangleMesh(7.0 * mesh.vertices @ turn.T + 3.0, mesh.faces), values),
        "renumbered": (TriangleMesh(mesh.vertices[places], order[mesh.faces]), values[places]),
        "turned faces": (TriangleMesh(mesh.vertices, np.roll(mesh.faces[::-1], 1, axis=1)), values),
        "other unit": (mesh, 1e3 * values),
    }
    model = TGV(weight=0.9, ratio=2.0)
    plain = model.run(Image(values, noise=20.0), fem(mesh), generalised_splitting).values
    for name, (other, image) in others.items():
        noise = 20.0 * (1e3 if name == "other unit" else 1.0)
        found = model.run(Image(image, noise=noise), fem(other), generalised_splitting).values
        back = found[order] if name == "renumbered" else found / (noise / 20.0)
        np.testing.assert_allclose(back, plain, atol=1e-5, err_msg=name)


def test_slopes_do_not_become_stairs() -> None:
    """On a slope with a step TGV is nearer to the truth than total variation at any of its weights."""
    mesh = rectangle(41, 21, 2.0, 1.0).mesh
    operator, rng = fem(mesh), np.random.default_rng(0)
    clean = 100 * mesh.vertices[:, 0] + 100 * (mesh.vertices[:, 0] > 1.21)
    image = Image(clean + 20 * rng.standard_normal(len(clean)), clean=clean, noise=20.0)
    stairs = min(ROF(weight=w).run(image, operator, primal_dual).metrics["rmse"] for w in (0.4, 0.6, 0.9, 1.3))
    assert TGV(ratio=4.0, weight=0.6).run(image, operator, generalised_splitting).metrics["rmse"] < 0.75 * stairs


def test_refusals() -> None:
    operator = noisy(1).operator
    data = rof(operator.mass, np.zeros(operator.vertex_count), 1.0)
    with pytest.raises(ValueError, match="ratio is 0"):
        GeneralisedVariation(data, operator, 0.0)
    with pytest.raises(ValueError, match="not convex Chan-Vese"):
        GeneralisedVariation(convex_chan_vese(operator.mass, np.ones(operator.vertex_count)), operator, 1.0)
    with pytest.raises(ValueError, match="denoise channels one by one"):
        GeneralisedVariation(rof(operator.mass, np.zeros((operator.vertex_count, 2)), 1.0), operator, 1.0)
    with pytest.raises(ValueError, match="choose operator fem"):
        GeneralisedVariation(data, vertex_averaged(icosphere(1).mesh), 1.0)
    problem = GeneralisedVariation(data, operator, 1.0)
    with pytest.raises(ValueError, match="relaxation is 2"):
        generalised_splitting(problem, relaxation=2.0)
    for solver in (generalised_splitting, generalised_primal_dual):
        with pytest.raises(ValueError, match="iteration_limit is 0"):
            solver(problem, iteration_limit=0)
        limited = solver(noisy(1), iteration_limit=3, tolerance=1e-12).solution
        assert not limited.converged and limited.reason == "iteration limit" and limited.iterations == 3


def test_another_image_on_the_same_mesh_shares_what_was_assembled() -> None:
    first = noisy()
    other = rof(first.operator.mass, 2.0 * first.fidelity.target, 0.3)
    shared, alone = first.with_fidelity(other), GeneralisedVariation(other, first.operator, first.ratio)
    assert shared.forms is first.forms and shared.fields is first.fields
    pair = [generalised_splitting(problem).solution.values for problem in (shared, alone)]
    assert pair[0] == pytest.approx(pair[1])


def test_splitting_needs_few_iterations_whatever_weight_noise_and_unit() -> None:
    """Its penalty follows the slopes of the image: 30 to 150 iterations over four octaves, the unit makes no difference."""
    problem = noisy()
    for weight in (0.25, 1.0, 4.0):
        counts = []
        for unit in (1e-3, 1.0, 1e3):
            data = rof(
                problem.operator.mass, unit * problem.fidelity.target, weight / unit * problem.fidelity.weight[0]
            )
            counts.append(generalised_splitting(problem.with_fidelity(data), tolerance=1e-2).solution.iterations)
        assert counts[0] == counts[1] == counts[2] <= 150


def test_the_dual_of_a_step_balances_without_a_factorisation_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("balanced by itself")

    monkeypatch.setattr(GeneralisedForms, "balanced", refuse)
    solution = generalised_splitting(noisy(2), tolerance=1e-6).solution
    assert solution.converged and solution.relative_gap <= 1e-6
    with pytest.raises(AssertionError, match="balanced by itself"):
        generalised_primal_dual(noisy(2), tolerance=1e-2)


def test_cutting_and_balancing_a_dual_proves_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """Faces that are too long by a little would shrink the whole field; the optimum is the same without."""
    plain = noisy()
    cut_and_balanced = generalised_splitting(plain, iteration_limit=30, tolerance=1e-9).solution
    monkeypatch.setattr(splitting, "ROUNDS", 0)
    shrunk = generalised_splitting(plain, iteration_limit=30, tolerance=1e-9).solution
    assert cut_and_balanced.energy == shrunk.energy
    assert cut_and_balanced.relative_gap < 0.8 * shrunk.relative_gap


def test_imbalance_is_a_share_of_the_largest_force() -> None:
    forms, rng = noisy(2).assembled, np.random.default_rng(0)
    dual = rng.standard_normal(forms.forms.shape[0])
    assert 0.1 < forms.imbalance(dual) <= 1.0
    assert forms.imbalance(1e6 * dual) == pytest.approx(forms.imbalance(dual))
    nearest = forms.balanced(dual)
    assert forms.imbalance(nearest) <= 1e-12 and forms.imbalance(np.zeros_like(dual)) == 0.0
    # what is taken away is orthogonal by area to all that balances
    other, areas = forms.balanced(rng.standard_normal(len(dual))), np.repeat(forms.operator.areas, 6)
    assert abs(other @ (areas * (dual - nearest))) <= 1e-10 * np.linalg.norm(other) * np.linalg.norm(areas * dual)
