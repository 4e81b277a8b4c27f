"""Heat trace and kernel: exact expansions on known shapes, what is heard, and the semigroup."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import jn_zeros, jnp_zeros

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.heat_kernel import diffuse, heat_kernel, heat_kernel_signature
from surfexp.spectrum.heat_trace import (
    corner_constant,
    hear_geometry,
    heat_trace,
    heat_trace_expansion,
    smooth_constant,
)

SPHERE = np.array([degree * (degree + 1.0) for degree in range(60) for _ in range(2 * degree + 1)])


def rectangle_values(a: float, b: float, condition: str, count: int = 60) -> np.ndarray:
    m = np.arange(0 if condition == "neumann" else 1, count)
    return np.sort((np.pi**2 * ((m[:, None] / a) ** 2 + (m[None, :] / b) ** 2)).ravel())


def disk_values(condition: str) -> np.ndarray:
    zeros = jn_zeros if condition == "dirichlet" else jnp_zeros
    found = [np.repeat(zeros(order, 40) ** 2, 1 if order == 0 else 2) for order in range(110)]
    found += [np.zeros(1)] if condition == "neumann" else []
    values = np.sort(np.concatenate(found))
    return values[values < 100.0**2]


def test_sphere() -> None:
    times = np.array([0.01, 0.02, 0.05])
    trace = heat_trace(SPHERE, times)
    assert trace[0] - 100.0 == pytest.approx(0.3340013, abs=1e-7)
    series = (
        heat_trace_expansion(times, 4.0 * np.pi, constant=smooth_constant(2)) + times / 15.0 + 4.0 * times**2 / 315.0
    )
    assert np.abs(trace - series).max() < 3e-6


@pytest.mark.parametrize("condition", ["dirichlet", "neumann"])
def test_rectangle_has_constant_one_quarter(condition: str) -> None:
    times = np.array([0.004, 0.008, 0.016])
    trace = heat_trace(rectangle_values(1.5, 1.0, condition), times)
    assert corner_constant(np.full(4, np.pi / 2.0)) == pytest.approx(0.25, abs=1e-15)
    assert np.abs(trace - heat_trace_expansion(times, 1.5, 5.0, 0.25, condition)).max() < 1e-8


@pytest.mark.parametrize("condition", ["dirichlet", "neumann"])
def test_disk(condition: str) -> None:
    times = np.array([0.002, 0.004, 0.008])
    trace = heat_trace(disk_values(condition), times)
    rest = trace - heat_trace_expansion(times, np.pi, 2.0 * np.pi, smooth_constant(1), condition)
    assert np.abs(rest).max() < 0.03
    assert np.log2(rest[1:] / rest[:-1]) == pytest.approx(0.5, abs=0.1)  # the next term is of order sqrt t


def test_polygon_corners_approach_the_smooth_boundary() -> None:
    sides = 4000
    assert corner_constant(np.full(sides, np.pi * (1.0 - 2.0 / sides))) == pytest.approx(1.0 / 6.0, rel=1e-3)


def test_geometry_is_heard() -> None:
    sphere = hear_geometry(SPHERE)
    assert sphere.area == pytest.approx(4.0 * np.pi, rel=1e-6)
    assert sphere.euler_characteristic == pytest.approx(2.0, abs=1e-3)
    torus = hear_geometry(
        np.sort((np.add.outer(np.arange(-40, 41) ** 2, np.arange(-40, 41) ** 2)).ravel() * 1.0)[:3000]
    )
    assert torus.area == pytest.approx(4.0 * np.pi**2, rel=1e-6) and abs(torus.euler_characteristic) < 1e-3
    drum = hear_geometry(disk_values("dirichlet"), "dirichlet")
    assert drum.area == pytest.approx(np.pi, rel=1e-5)
    assert drum.boundary_length == pytest.approx(2.0 * np.pi, rel=1e-4)
    assert drum.euler_characteristic == pytest.approx(1.0, abs=1e-2)
    free = hear_geometry(rectangle_values(1.5, 1.0, "neumann")[:2000], "neumann", area=1.5)
    assert free.boundary_length == pytest.approx(5.0, rel=1e-4) and free.constant == pytest.approx(0.25, abs=1e-3)


def test_trace_of_a_computed_spectrum_with_weyls_tail() -> None:
    project = lambda points: points / np.linalg.norm(points, axis=1, keepdims=True)  # noqa: E731
    elements = surface_elements(icosphere(3).mesh, 2, project)
    system = eigenpairs(elements.stiffness, elements.mass, 121)
    times = np.array([0.02, 0.05])
    exact = heat_trace(SPHERE, times)
    assert np.abs(heat_trace(system.values, times, elements.area) / exact - 1.0).max() < 6e-3
    assert abs(heat_trace(system.values, times)[0] / exact[0] - 1.0) > 0.05


def test_kernel_diffusion_and_signature() -> None:
    mesh = icosphere(3).mesh
    elements = surface_elements(mesh)
    system = eigenpairs(elements.stiffness, elements.mass, 100)
    rng = np.random.default_rng(0)
    function = rng.normal(size=(642, 2))
    # a semigroup that keeps the mean, and acts by the kernel
    once, twice = diffuse(system, elements.mass, function, 0.3), diffuse(system, elements.mass, function, 0.1)
    assert np.allclose(once, diffuse(system, elements.mass, twice, 0.2), atol=1e-9)
    total = elements.mass.sum(axis=0)
    assert np.allclose(total @ once, total @ function, atol=1e-9)
    kernel = heat_kernel(system, 0.3, np.arange(642))
    assert np.allclose(kernel, kernel.T, atol=1e-12)
    assert np.allclose(kernel @ (elements.mass @ function), once, atol=1e-9)
    assert np.allclose(diffuse(system, elements.mass, function[:, 0], 0.3), once[:, 0])
    # P_1 decays like exp(-2 t) on the sphere
    height = mesh.vertices[:, 2]
    assert np.allclose(diffuse(system, elements.mass, height, 0.5), np.exp(-1.0) * height, atol=5e-3)
    # the signature is the diagonal
    assert np.allclose(heat_kernel_signature(system, np.array([0.3]))[:, 0], kernel.diagonal(), atol=1e-12)


def test_unfit_times_and_conditions_are_refused() -> None:
    elements = surface_elements(disk(4).mesh)
    system = eigenpairs(elements.stiffness, elements.mass, 5)
    with pytest.raises(ValueError, match="backwards"):
        diffuse(system, elements.mass, np.ones(61), -1.0)
    with pytest.raises(ValueError, match="not positive"):
        heat_trace(system.values, np.array([0.0]))
    with pytest.raises(ValueError, match="too few"):
        hear_geometry(system.values)
    with pytest.raises(ValueError, match="choose closed"):
        heat_trace_expansion(np.ones(1), 1.0, condition="open")
