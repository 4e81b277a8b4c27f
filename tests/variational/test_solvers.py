"""What belongs to one solver: limits, refusals, bias, tangency, and the published schemes with their known defects."""

import importlib.util
from functools import partial

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.vertex_averaged import vertex_averaged
from surfexp.variational.duality_gap import certify, recertify
from surfexp.variational.image import Image
from surfexp.variational.published.averaged_iterations import averaged_primal_dual
from surfexp.variational.published.chambolle import published_chambolle
from surfexp.variational.published.split_bregman import published_split_bregman
from surfexp.variational.published.vector_pair import VectorPair, shrink
from surfexp.variational.separable_quadratic import SeparableQuadratic, convex_chan_vese, inpainting, rof
from surfexp.variational.solvers.chambolle_dual import chambolle_dual
from surfexp.variational.solvers.conic import conic
from surfexp.variational.solvers.fista_dual import fista_dual
from surfexp.variational.solvers.gradient_descent import gradient_descent
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.solvers.split_bregman import split_bregman

from . import independent_certificate as independent

ALL = [primal_dual, split_bregman, chambolle_dual, fista_dual, gradient_descent, newton]


def denoising(surface: Surface, image: Image) -> SeparableQuadratic:
    operator = fem(surface.mesh)
    return rof(operator.mass, image.values, 0.9 / (40.0 * operator.edge_length))


def segmenting(surface: Surface, image: Image, length: float = 2.0) -> SeparableQuadratic:
    operator = fem(surface.mesh)
    slope = ((255 - image.values) ** 2 - image.values**2) / 255**2 / (length * operator.edge_length)
    return convex_chan_vese(operator.mass, slope)


@pytest.mark.parametrize("method", ALL)
def test_iteration_limit_is_said_and_the_result_is_certified(surface: Surface, image: Image, method: object) -> None:
    fidelity, operator = denoising(surface, image), fem(surface.mesh)
    seen: list[tuple[int, float]] = []
    options = {"iteration_limit": 3, "tolerance": 1e-12, "progress": lambda k, gap: seen.append((k, gap))}
    solution = method(fidelity, operator, **options)  # type: ignore[operator]
    assert not solution.converged and solution.reason == "iteration limit" and solution.iterations == 3
    assert seen[-1] == (3, solution.relative_gap)
    mass, load = independent.lumped(surface.mesh), independent.load_of(surface.mesh, operator, solution.dual)
    mu = fidelity.strong_convexity
    deviation = solution.values - image.values
    energy = independent.total_variation(surface.mesh, solution.values) + 0.5 * mu * mass @ deviation**2
    independent.check(solution, energy, float(image.values @ load - load @ (load / mass) / (2 * mu)))
    assert solution.error_bound == pytest.approx(np.sqrt(2 * (energy - solution.lower_bound) / mu))


def test_certificate_belongs_to_the_values_that_are_returned(surface: Surface, image: Image) -> None:
    fidelity, operator = denoising(surface, image), fem(surface.mesh)
    for method in (primal_dual, split_bregman):
        for limit in (10, 20, 30, 60, 120):
            solution = method(fidelity, operator, iteration_limit=limit, tolerance=0.0)
            load = independent.load_of(surface.mesh, operator, solution.dual)
            again = certify(fidelity, operator, solution.values, load)
            assert again.energy == pytest.approx(solution.energy, rel=1e-12)
            assert again.lower_bound == pytest.approx(solution.lower_bound, rel=1e-12)


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_change_rounding_only_and_repeat_to_the_byte(surface: Surface, image: Image, threads: int) -> None:
    fidelity, operator = denoising(surface, image), fem(surface.mesh)
    run = partial(primal_dual, fidelity, operator, tolerance=1e-12, iteration_limit=50)
    one, several, again = run(), run(threads=threads), run(threads=threads)
    assert several.values.tobytes() == again.values.tobytes()
    np.testing.assert_allclose(several.values, one.values, rtol=1e-10, atol=1e-9)
    for refused in (0, len(operator.faces) + 1):
        with pytest.raises(ValueError, match=f"threads = {refused}"):
            run(threads=refused)


def test_a_limit_of_zero_is_refused(surface: Surface, image: Image) -> None:
    for operator in (fem(surface.mesh), vertex_averaged(surface.mesh)):
        with pytest.raises(ValueError, match="iteration_limit is 0"):
            primal_dual(denoising(surface, image), operator, iteration_limit=0)


def test_error_bound_holds(surface: Surface, image: Image) -> None:
    fidelity, operator = denoising(surface, image), fem(surface.mesh)
    exact = newton(fidelity, operator).values
    for limit in (10, 30, 100):
        solution = primal_dual(fidelity, operator, iteration_limit=limit, tolerance=0.0)
        assert np.sqrt(operator.mass @ (solution.values - exact) ** 2) <= solution.error_bound


@pytest.mark.parametrize("seed", [11, 26])
def test_newton_leaves_the_boundary_of_its_cones_again(seed: int) -> None:
    """After long first steps some faces lie on |p| = 1 to rounding, and steps that keep them inside have no length."""
    mesh = torus(40, 40).mesh
    operator, points = fem(mesh), mesh.vertices
    noise = (10 + seed % 4 * 20) * np.random.default_rng(seed).standard_normal(len(points))
    picture = 255.0 * ((np.sin(7.0 * points[:, 0] + seed) > 0) & (points[:, 2] > 0)) + noise
    solution = newton(rof(operator.mass, picture, 0.3 / (40.0 * operator.edge_length)), operator)
    assert solution.converged and solution.iterations <= 20
    again = recertify(solution, rof(operator.mass, picture, 0.3 / (40.0 * operator.edge_length)), operator)
    assert again.relative_gap == pytest.approx(solution.relative_gap, rel=1e-3)
    assert np.linalg.norm(solution.dual, axis=1).max() <= 1.0


def test_gradient_descent_is_biased_by_its_smoothing(surface: Surface, image: Image) -> None:
    fidelity, operator = denoising(surface, image), fem(surface.mesh)
    best = newton(fidelity, operator).energy
    excess = []
    for smoothing in (400.0, 100.0):
        solution = gradient_descent(fidelity, operator, smoothing=smoothing, tolerance=1e-9, iteration_limit=4000)
        excess.append(solution.energy - best)
        assert 0 < solution.energy - solution.lower_bound <= smoothing * operator.areas.sum()
    assert excess[1] < 0.5 * excess[0]


def test_what_a_solver_cannot_solve_is_refused(surface: Surface, image: Image) -> None:
    operator, averaged = fem(surface.mesh), vertex_averaged(surface.mesh)
    hole = inpainting(operator.mass, image.values, image.known, 1.0)
    for method in (chambolle_dual, fista_dual, newton):
        with pytest.raises(ValueError, match="use primal_dual or split_bregman"):
            method(hole, operator)
    for method in (fista_dual, gradient_descent, newton):
        with pytest.raises(ValueError, match="use operator fem"):
            method(denoising(surface, image), averaged)
    for method in (published_split_bregman, published_chambolle):
        with pytest.raises(ValueError, match="not inpainting"):
            method(hole, operator)
    colours = rof(operator.mass, np.ones((operator.vertex_count, 3)), 1.0)
    for method in (primal_dual, split_bregman, chambolle_dual):
        with pytest.raises(ValueError, match="use operator fem"):
            method(colours, averaged)
    with pytest.raises(ValueError, match=r"relaxation is 2\.0"):
        split_bregman(hole, operator, relaxation=2.0)
    with pytest.raises(ValueError, match="tau is 1"):
        published_chambolle(denoising(surface, image), operator, tau=1.0)
    with pytest.raises(ValueError, match="inner is 'lu'"):
        published_split_bregman(denoising(surface, image), operator, inner="lu")  # type: ignore[arg-type]


@pytest.mark.optional
def test_conic_names_how_it_ended_without_a_solution(
    surface: Surface, image: Image, monkeypatch: pytest.MonkeyPatch
) -> None:
    programme = pytest.importorskip("cvxpy").Problem
    monkeypatch.setattr(programme, "solve", lambda *_, **__: None)
    operator = fem(surface.mesh)
    with pytest.raises(ValueError, match="CLARABEL ended with status None and no solution"):
        conic(rof(operator.mass, image.values, 1.0), operator)


def test_conic_agrees_or_names_what_is_missing(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    if importlib.util.find_spec("cvxpy") is None or importlib.util.find_spec("clarabel") is None:
        with pytest.raises(ImportError, match=r"surfexp\[conic\]"):
            conic(denoising(surface, image), operator)
        return
    for fidelity in (denoising(surface, image), segmenting(surface, image, 0.5)):
        ours, theirs = primal_dual(fidelity, operator, tolerance=1e-6), conic(fidelity, operator)
        assert theirs.converged
        assert ours.energy - theirs.energy <= 1e-6 * fidelity.gap_scale(ours.energy, ours.lower_bound)


def test_remark_2_3_1_fields_stay_tangent(surface: Surface, image: Image) -> None:
    """Exact for fields on faces; with the published vertex gradient V and b leave the tangent plane."""
    mesh, parts = surface.mesh, {}
    for operator, normals in ((fem(mesh), mesh.face_normals), (vertex_averaged(mesh), mesh.vertex_normals)):
        pair, field = VectorPair(operator), 0.0
        for _ in range(3):
            ahead = pair.gradient(image.values) + field
            shorter = shrink(ahead, 50.0)
            field = ahead - shorter
        if operator.frames is not None and operator.consistent:
            field = np.einsum("fa,fax->fx", field, operator.frames)
        parts[operator.name] = np.abs((field * normals).sum(axis=1)).max() / np.linalg.norm(field, axis=1).max()
    assert parts["fem"] <= 1e-12 and parts["vertex_averaged"] > 1e-3


@pytest.mark.parametrize("method", [primal_dual, split_bregman, chambolle_dual])
def test_published_pair_is_audited_under_the_consistent_energy(surface: Surface, image: Image, method: object) -> None:
    fidelity, operator, averaged = denoising(surface, image), fem(surface.mesh), vertex_averaged(surface.mesh)
    solution = method(fidelity, averaged, iteration_limit=300)  # type: ignore[operator]
    sound = primal_dual(fidelity, operator, tolerance=1e-5)
    assert any("no energy gap of its own" in note for note in solution.notes)
    assert solution.relative_gap > 0.01 and solution.lower_bound == pytest.approx(sound.energy, rel=1e-4)
    load = independent.load_of(surface.mesh, operator, solution.dual)
    again = certify(fidelity, operator, solution.values, load)
    assert again.energy == pytest.approx(solution.energy) and again.lower_bound == pytest.approx(solution.lower_bound)
    assert solution.error_bound > np.sqrt(operator.mass @ (solution.values - sound.values) ** 2) - sound.error_bound


@pytest.mark.slow
def test_limit_of_the_published_pair_depends_on_lambda_and_that_of_the_sound_one_does_not(
    surface: Surface, image: Image
) -> None:
    fidelity, operator, averaged = denoising(surface, image), fem(surface.mesh), vertex_averaged(surface.mesh)
    base = fidelity.strong_convexity * operator.edge_length**2
    distances = []
    for which, method in ((averaged, published_split_bregman), (operator, split_bregman)):
        options = {"inner": "direct"} if method is published_split_bregman else {}
        low, high = (
            method(fidelity, which, penalty=k * base, tolerance=1e-7, iteration_limit=2000, **options).values
            for k in (0.5, 5.0)
        )
        distances.append(np.sqrt(operator.mass @ (low - high) ** 2 / operator.mass.sum()))
    assert distances[0] > 7.0 and distances[1] < 0.2


def test_the_better_the_published_poisson_step_is_solved_the_worse_the_answer(surface: Surface, image: Image) -> None:
    truth = image.labels["bright"]
    mass, operator = fem(surface.mesh).mass, vertex_averaged(surface.mesh)
    fidelity = segmenting(surface, image, 1.0)
    accuracy = []
    for inner, sweeps in (("gauss_seidel", 1), ("gauss_seidel", 50), ("direct", 1)):
        run = partial(published_split_bregman, inner=inner, sweeps=sweeps, iteration_limit=100)
        accuracy.append(mass @ ((run(fidelity, operator).values > 0.5) == truth) / mass.sum())
    best = mass @ ((primal_dual(fidelity, fem(surface.mesh)).values > 0.5) == truth) / mass.sum()
    assert best >= accuracy[0] > accuracy[1] and accuracy[0] > accuracy[2]


def test_conjugate_gradients_and_sweeps_tend_to_the_direct_solve(surface: Surface, image: Image) -> None:
    fidelity, operator = denoising(surface, image), fem(surface.mesh)
    runs = {
        name: published_split_bregman(
            fidelity, operator, inner=name, sweeps=200, laplacian="(1.19)", iteration_limit=20
        )
        for name in ("direct", "cg", "gauss_seidel")
    }
    for run in runs.values():
        assert np.abs(run.values - runs["direct"].values).max() <= 1e-4


@pytest.mark.slow
def test_published_dual_segmentation_is_biased_by_theta(surface: Surface, image: Image) -> None:
    fidelity, operator = segmenting(surface, image, 0.5), fem(surface.mesh)
    best = primal_dual(fidelity, operator, tolerance=1e-6)
    size, excess = np.abs(fidelity.slope).mean(), []
    for factor in (1.0, 10.0):
        run = published_chambolle(fidelity, operator, theta=factor * size, tolerance=1e-9, iteration_limit=1500)
        excess.append((run.energy - best.lower_bound) / float(operator.mass @ np.abs(fidelity.slope)))
    assert excess[0] > 2 * excess[1] > 0


def test_split_bregman_goes_on_where_it_ended() -> None:
    """One step from a solution has its gap: values, multipliers and the mixed variable belong together."""
    sphere = icosphere(3)
    operator, rough = fem(sphere.mesh), np.random.default_rng(0).normal(size=len(sphere.mesh.vertices))
    fidelity = convex_chan_vese(operator.mass, 4.0 * (3.0 * sphere.mesh.vertices[:, 2] + rough))
    best = split_bregman(fidelity, operator, tolerance=1e-7, iteration_limit=5000)
    one_step = partial(split_bregman, fidelity, operator, tolerance=1e-12, iteration_limit=1)
    cold, warm = one_step(), one_step(best)
    assert best.converged and cold.relative_gap > 0.1
    assert warm.relative_gap == pytest.approx(best.relative_gap, rel=0.1)


def test_averaged_steps_begin_where_they_are_told(surface: Surface, image: Image) -> None:
    """From the values of a start, or from those of the fidelity; a step of nearly no length leaves them."""
    averaged = vertex_averaged(surface.mesh)
    fidelity = denoising(surface, image)
    known = primal_dual(fidelity, fem(surface.mesh), iteration_limit=50)
    tiny = 1e-12
    _, plain = next(averaged_primal_dual(fidelity, averaged, None, tiny, 1))
    _, warm = next(averaged_primal_dual(fidelity, averaged, known, tiny, 1))
    assert plain == pytest.approx(fidelity.initial(), abs=1e-6) and warm == pytest.approx(known.values, abs=1e-6)
    assert np.abs(warm - plain).max() > 1.0
