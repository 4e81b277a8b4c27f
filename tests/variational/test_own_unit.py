"""An offset or a unit of the map changes neither the result nor its proof; what proves nothing is never called converged."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.calculus import adjoint_gradient, total_variation
from surfexp.operators.fem import fem
from surfexp.variational.duality_gap import Iterate, certificate_of, certify, run_to_gap
from surfexp.variational.generalised_variation import GeneralisedVariation
from surfexp.variational.own_unit import own_unit
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.fista_dual import fista_dual
from surfexp.variational.solvers.generalised_splitting import generalised_splitting
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual

MESH = icosphere(3).mesh
OPERATOR = fem(MESH)
MAP = MESH.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(len(MESH.vertices))
MU = 0.9 / (0.1 * OPERATOR.edge_length)
GENERAL = GeneralisedVariation(rof(OPERATOR.mass, MAP, MU), OPERATOR, 2.0 * OPERATOR.edge_length)


def test_a_map_in_its_own_unit_goes_from_minus_one_to_one() -> None:
    channels = np.array([[2.0, -1.0], [6.0, 0.0], [3.0, 5.0]])
    for values, centre, unit in ((channels[:, 0], 4.0, 2.0), (channels, [4.0, 2.0], 3.0), (np.full(3, 7.0), 7.0, 1.0)):
        own = own_unit(values)
        assert own.unit == unit and np.array_equal(own.centre, centre)
        assert np.array_equal(own.restored(own.normalised(values)), values)
    assert own_unit(channels[:, 0]).normalised(channels[:, 0]).tolist() == [-1.0, 1.0, -0.5]


def solved(name: str, scale: float, offset: float) -> Solution:
    data = rof(OPERATOR.mass, scale * (MAP + offset), MU / scale)
    if name == "tgv":
        return generalised_splitting(GENERAL.with_fidelity(data), tolerance=1e-3).solution
    solver = {"primal_dual": primal_dual, "newton": newton, "fista_dual": fista_dual}[name]
    return solver(data, OPERATOR, tolerance=1e-4)


NAMES = ("primal_dual", "newton", "fista_dual", "tgv")


@cache
def reference(name: str) -> Solution:
    return solved(name, 1.0, 0.0)


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=12)
@given(decade=st.floats(-12.0, 12.0), offset=st.floats(-1e6, 1e6))
@example(decade=0.0, offset=5e6)
@example(decade=-165.0, offset=0.0)
@example(decade=150.0, offset=0.0)
def test_offset_and_unit_change_neither_result_nor_gap(name: str, decade: float, offset: float) -> None:
    scale, one = 10.0**decade, reference(name)
    other = solved(name, scale, offset)
    # the map itself is rounded by the offset
    rounding = 1e-12 + 100.0 * np.finfo(float).eps * abs(offset)
    assert other.iterations == one.iterations and other.converged
    assert other.values / scale - offset == pytest.approx(one.values, abs=rounding)
    assert one.relative_gap is not None and one.error_bound is not None
    assert other.relative_gap == pytest.approx(one.relative_gap, rel=1e-3, abs=rounding)
    assert other.error_bound == pytest.approx(scale * one.error_bound, rel=1e-3)
    assert other.energy == pytest.approx(scale * one.energy, rel=1e-9)


def test_the_bound_of_the_error_is_that_of_strong_convexity() -> None:
    """For mu-strongly convex energies |u - u*|^2 <= 2 gap / mu; both models recompute it."""
    for found in map(reference, NAMES):
        assert found.lower_bound is not None
        gap = found.energy - found.lower_bound
        assert found.error_bound == pytest.approx(np.sqrt(2.0 * gap / MU), rel=1e-6)


def test_a_constant_map_is_its_own_minimiser_with_gap_zero() -> None:
    flat = np.full(len(MAP), 7.0)
    for solver in (primal_dual, newton, fista_dual):
        found = solver(rof(OPERATOR.mass, flat, 1.0), OPERATOR, tolerance=1e-4)
        assert found.converged and found.relative_gap == 0.0 and np.array_equal(found.values, flat)


@pytest.mark.parametrize(("energy", "bound"), [(1.0, 1.5), (np.nan, 0.0), (1.0, np.nan), (np.nan, np.nan)])
def test_a_bound_above_the_energy_or_no_number_proves_nothing(energy: float, bound: float) -> None:
    found = certificate_of(energy, bound, 1.0, 1.0)
    assert found.lower_bound == -np.inf and found.relative_gap == np.inf and found.error_bound is None


def test_a_gap_below_rounding_is_zero() -> None:
    found = certificate_of(1.0, 1.0 + 1e-14, 1.0, 1.0)
    assert found.relative_gap == 0.0 and found.error_bound == 0.0


def test_a_field_that_is_no_number_does_not_converge() -> None:
    data = rof(OPERATOR.mass, MAP, MU)
    dual = np.zeros((len(MESH.faces), 2))
    iterate = Iterate(1, np.full(len(MAP), np.nan), dual, adjoint_gradient(OPERATOR, dual))
    found = run_to_gap([iterate], data, OPERATOR, "none", 1e-4)
    assert not found.converged and found.lower_bound is None


def test_the_certificate_is_that_of_the_definition() -> None:
    data = rof(OPERATOR.mass, MAP, MU)
    dual = np.random.default_rng(1).uniform(-0.5, 0.5, (len(MESH.faces), 2))
    load = adjoint_gradient(OPERATOR, dual)
    found = certify(data, OPERATOR, MAP, load)
    assert found.energy == pytest.approx(total_variation(OPERATOR, MAP))
    assert found.lower_bound == pytest.approx(load @ MAP - (load**2 / OPERATOR.mass).sum() / (2.0 * MU))


@pytest.mark.parametrize("name", ["primary", "tgv"])
def test_metrics_are_in_the_unit_of_the_map_as_the_solution_is(name: str) -> None:
    found = solved("tgv" if name == "tgv" else "primal_dual", 250.0, 3.0)
    assert found.metrics["energy"] == pytest.approx(found.energy, rel=1e-12)
    for metric, value in (("lower_bound", found.lower_bound), ("error_bound", found.error_bound)):
        if metric in found.metrics:
            assert found.metrics[metric] == pytest.approx(value, rel=1e-12)
