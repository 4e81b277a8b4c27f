"""All consistent solvers, models and operators agree at a relative gap of 1e-6, and every certificate is computed again."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.operators.libigl_operator import libigl_operator
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import recertify
from surfexp.variational.fidelity import Fidelity, Method
from surfexp.variational.heat_blur import HeatBlur
from surfexp.variational.image import Image
from surfexp.variational.published.split_bregman import published_split_bregman
from surfexp.variational.separable_quadratic import SeparableQuadratic, convex_chan_vese, inpainting, rof
from surfexp.variational.simplex_labelling import SimplexLabelling
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_dual import chambolle_dual
from surfexp.variational.solvers.fista_dual import fista_dual
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.solvers.split_bregman import split_bregman

from . import independent_certificate as independent

TOLERANCE = 1e-6
OPERATORS = {"fem": fem, "libigl": libigl_operator, "intrinsic_delaunay": intrinsic_delaunay}
anything: list[Method] = [partial(primal_dual, iteration_limit=60000), partial(split_bregman, iteration_limit=20000)]
strong: list[Method] = [fista_dual, partial(chambolle_dual, iteration_limit=100000)]


def build(model: str, operator: SurfaceOperator, image: Image) -> Fidelity:
    mu = 0.9 / (40.0 * operator.edge_length)
    length = 2.0 * operator.edge_length
    if model == "rof":
        return rof(operator.mass, image.values, mu)
    if model == "vector rof":
        return rof(operator.mass, np.stack([image.values, 255 - image.values, 0.5 * image.values**1.0], axis=1), mu)
    if model == "inpainting":
        assert image.known is not None
        return inpainting(operator.mass, image.values, image.known, mu)
    if model == "chan-vese":
        return convex_chan_vese(operator.mass, ((250 - image.values) ** 2 - image.values**2) / 250**2 / length)
    if model == "deblurring":
        return HeatBlur(operator, image.values, mu, 0.5 * operator.edge_length**2)
    costs = np.stack([(c - image.values) ** 2 for c in (0.0, 130.0, 255.0)], axis=1) / 130.0**2 / length
    return SimplexLabelling(operator.mass, np.sqrt(2.0) * costs)


published = partial(published_split_bregman, laplacian="(1.19)", inner="direct", penalty=0.01, iteration_limit=5000)
MODELS = {
    "rof": [*anything, *strong, newton, published],
    "vector rof": [*anything, *strong],
    "inpainting": anything,
    "chan-vese": anything,
    "deblurring": anything,
    "simplex": anything,
}


def independent_energies(
    fidelity: Fidelity, surface: Surface, operator: SurfaceOperator, solution: Solution
) -> tuple[float, float]:
    """Energy and bound written out with numpy for each fidelity."""
    mesh = surface.mesh
    mass, load = independent.lumped(mesh), independent.load_of(mesh, operator, solution.dual)
    phi, tv = solution.values, independent.total_variation(mesh, solution.values)
    if isinstance(fidelity, SeparableQuadratic):
        a, target, r = fidelity.weight, fidelity.target, fidelity.slope
        m = mass.reshape(-1, *[1] * (phi.ndim - 1))
        assert (phi >= fidelity.lower).all() and (phi <= fidelity.upper).all()
        energy = tv + (m * (0.5 * a * (phi - target) ** 2 + r * phi)).sum()
        with np.errstate(divide="ignore", invalid="ignore"):
            free = target - (load / m + r) / a
            ends = np.where(load + m * r > 0, fidelity.lower, fidelity.upper)
        best = np.where(a > 0, np.clip(free, fidelity.lower, fidelity.upper), ends)
        return energy, float((load * best + m * (0.5 * a * (best - target) ** 2 + r * best)).sum())
    if isinstance(fidelity, SimplexLabelling):
        costs = mass[:, None] * fidelity.costs
        return tv + float((costs * phi).sum()), float((load + costs).min(axis=1).sum())
    assert isinstance(fidelity, HeatBlur)
    weights = independent.face_weights(mesh)
    local = np.einsum("f,fix,fjx->fij", independent.heron_areas(mesh), weights, weights)
    heat = np.diag(mass)
    for face, block in zip(mesh.faces, local, strict=True):
        heat[np.ix_(face, face)] += fidelity.time * block
    energy = tv + 0.5 * fidelity.mu * mass @ (np.linalg.solve(heat, mass * phi) - fidelity.image) ** 2
    second = -(heat @ (load / mass)) / mass
    return energy, float(-(mass * second) @ fidelity.image - (mass @ second**2) / (2 * fidelity.mu))


QUICK = {("fem", model) for model in MODELS if model != "deblurring"} | {
    ("libigl", "chan-vese"),
    ("intrinsic_delaunay", "chan-vese"),
}
PAIRS = [
    pytest.param(name, model, marks=() if (name, model) in QUICK else pytest.mark.slow)
    for name in OPERATORS
    for model in MODELS
]


@pytest.mark.parametrize(("operator_name", "model"), PAIRS)
def test_solvers_agree(surface: Surface, image: Image, operator_name: str, model: str) -> None:
    make: Callable[..., SurfaceOperator] = OPERATORS[operator_name]
    operator = make(surface.mesh)
    fidelity = build(model, operator, image)
    solutions = []
    for method in MODELS[model]:
        solution = method(fidelity, operator, tolerance=TOLERANCE)  # type: ignore[call-arg]
        assert solution.converged and solution.reason == "gap below tolerance", solution.solver
        assert solution.relative_gap is not None and solution.relative_gap <= TOLERANCE
        again = recertify(solution, fidelity, operator)
        assert again.energy == pytest.approx(solution.energy, rel=1e-12)
        if operator.frames is not None:
            independent.check(solution, *independent_energies(fidelity, surface, operator, solution))
        solutions.append(solution)
    best = max(s.lower_bound for s in solutions)
    for solution in solutions:
        assert solution.energy - best <= 2 * TOLERANCE * fidelity.gap_scale(solution.energy, best)
        if fidelity.strong_convexity > 0:
            difference = operator.mass @ ((solution.values - solutions[0].values) ** 2).reshape(len(image.values), -1)
            assert np.sqrt(difference.sum()) <= solution.error_bound + solutions[0].error_bound


def test_libigl_and_fem_give_the_same_field(surface: Surface, image: Image) -> None:
    fields = []
    for make in (fem, libigl_operator):
        operator = make(surface.mesh)
        fields.append(primal_dual(build("rof", operator, image), operator, tolerance=1e-3).values)
    assert np.abs(fields[0] - fields[1]).max() <= 1e-8


def test_warm_start_begins_where_the_first_run_ended(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    for model in ("rof", "chan-vese"):
        fidelity = build(model, operator, image)
        for method in anything:
            first = method(fidelity, operator)
            assert method(fidelity, operator, first).iterations <= max(20, first.iterations // 3)


def test_bytes_are_the_same_twice(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    for method in MODELS["rof"]:
        first, second = (method(build("rof", operator, image), operator) for _ in range(2))
        assert first.values.tobytes() == second.values.tobytes() and first.dual.tobytes() == second.dual.tobytes()
