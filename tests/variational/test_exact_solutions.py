"""Closed forms: a triangle, a disk in a disk, a cap on the sphere, and a surface of revolution against 1-D total variation."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.spherical_cap import capped_sphere
from surfexp.mesh.shapes.surface_of_revolution import surface_of_revolution
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.variational.fidelity import Method
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solvers.fista_dual import fista_dual
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.solvers.split_bregman import split_bregman


@pytest.mark.parametrize(
    ("method", "bound"), [(primal_dual, 1e-3), (split_bregman, 1e-8), (fista_dual, 1e-8), (newton, 1e-8)]
)
def test_equilateral_triangle_shrinks_by_the_known_factor(method: Method, bound: float) -> None:
    """phi - mean = (1 - 3 sqrt 2 / (mu |e|)) e with e = I - mean; primal-dual iterations approach it like 1/k only."""
    mesh = TriangleMesh(np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.75**0.5, 0]]), np.array([[0, 1, 2]]))
    operator, values, mu = fem(mesh), np.array([3.0, -1.0, 5.0]), 7.0
    deviation = values - values.mean()
    exact = values.mean() + (1 - 3 * 2**0.5 / (mu * np.linalg.norm(deviation))) * deviation
    limit = {"tolerance": -1.0, "iteration_limit": 12 if method is newton else 2000}
    solution = method(rof(operator.mass, values, mu), operator, **limit)  # type: ignore[arg-type]
    assert np.abs(solution.values - exact).max() <= bound


def two_values(surface: Surface, radius: float, length: float, area: float, mu: float) -> tuple[np.ndarray, np.ndarray]:
    """The indicator of {coordinate < radius}, one half on the rim, and the exact solution of ROF for it."""
    distance, mass = surface.coordinates[:, 0], fem(surface.mesh).mass
    indicator = np.where(distance < radius - 1e-9, 1.0, 0.0)
    indicator[np.abs(distance - radius) <= 1e-9] = 0.5
    total = {"disk": np.pi, "sphere": 4 * np.pi}[surface.name]
    inside, outside = 1 - length / (mu * area), length / (mu * (total - area))
    assert inside > outside and abs(mass.sum() / total - 1) < 0.03
    return indicator, outside + (inside - outside) * indicator


@pytest.mark.parametrize(("shape", "mu"), [("disk", 16.0), ("sphere", 12.0)])
def test_jump_across_a_circle_converges(shape: str, mu: float) -> None:
    """The two constants converge at first order in h, the field at better than half an order (the jump layer)."""
    errors, constants = [], []
    for rings in (8, 16, 32):
        if shape == "disk":
            surface, radius, length, area = disk(rings), 0.5, np.pi, np.pi / 4
        else:
            surface, radius = capped_sphere(1.0, rings), 1.0
            length, area = 2 * np.pi * np.sin(1.0), 2 * np.pi * (1 - np.cos(1.0))
        indicator, exact = two_values(surface, radius, length, area, mu)
        operator = fem(surface.mesh)
        solution = newton(rof(operator.mass, indicator, mu), operator, tolerance=1e-8)
        errors.append(np.sqrt(operator.mass @ (solution.values - exact) ** 2))
        constants.append(abs(solution.values[0] - exact[0]))
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 0.7).all()
    assert (np.log2(np.array(constants[:-1]) / constants[1:]) > 0.95).all()
    assert constants[-1] < 0.01


def weighted_total_variation(masses: np.ndarray, radii: np.ndarray, values: np.ndarray, mu: float) -> np.ndarray:
    """min sum_j 2 pi r_j |u_(j+1) - u_j| + mu/2 sum_i m_i (u_i - I_i)^2 by bounded least squares on the dual."""
    weights = 2 * np.pi * radii
    difference = (np.eye(len(values))[1:] - np.eye(len(values))[:-1]) * weights[:, None]
    scaled = difference.T / (mu * np.sqrt(masses)[:, None])
    fit = lsq_linear(scaled, np.sqrt(masses) * values, bounds=(-1.0, 1.0), tol=1e-12, max_iter=500)
    return values - difference.T @ fit.x / (mu * masses)


def test_surface_of_revolution_reduces_to_weighted_1d() -> None:
    errors = []
    for rows in (20, 40, 80):
        surface = surface_of_revolution("pear", rows, 2 * rows)
        arc, operator = surface.coordinates[:, 0], fem(surface.mesh)
        values = np.sin(2.1 * arc) + np.where(arc > 0.5 * arc.max(), 1.0, 0.0)
        solution = newton(rof(operator.mass, values, 12.0), operator, tolerance=1e-9)
        station, ring = np.unique(np.round(arc, 9), return_inverse=True)
        masses = np.bincount(ring, operator.mass)
        radius = np.bincount(ring, np.hypot(*surface.mesh.vertices[:, :2].T)) / np.bincount(ring)
        profile = np.bincount(ring, operator.mass * values) / masses
        exact = weighted_total_variation(masses, 0.5 * (radius[1:] + radius[:-1]), profile, 12.0)
        assert len(station) == rows + 2
        errors.append(np.sqrt(operator.mass @ (solution.values - exact[ring]) ** 2 / operator.mass.sum()))
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 0.7).all()
    assert errors[-1] < 0.01
