"""Energies of labellings: the cut is the total variation of the indicator; the least of all is known by a minimum cut."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import maximum_flow

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.labellings import best_threshold, edge_cut
from surfexp.variational.level_sets import perimeters
from surfexp.variational.separable_quadratic import convex_chan_vese
from surfexp.variational.solvers.primal_dual import primal_dual

OPERATOR = fem(torus(24, 12, jitter=0.2, seed=1).mesh)
UNITS = 10**7


def least_cut(operator: SurfaceOperator, slope: np.ndarray) -> float:
    """The least TV(1_S) + sum m r over S, by a maximum flow between a source and a sink, to 1e-7 of the largest capacity."""
    cut, n = edge_cut(operator), operator.vertex_count
    data = operator.mass * slope
    rows = np.concatenate([cut.edges[:, 0], cut.edges[:, 1], np.full(n, n), np.arange(n)])
    columns = np.concatenate([cut.edges[:, 1], cut.edges[:, 0], np.arange(n), np.full(n, n + 1)])
    capacities = np.concatenate([cut.weights, cut.weights, np.maximum(-data, 0.0), np.maximum(data, 0.0)])
    unit = capacities.max() / UNITS
    matrix = csr_array(coo_array((np.round(capacities / unit).astype(np.int32), (rows, columns)), (n + 2, n + 2)))
    return float(maximum_flow(matrix, n, n + 1).flow_value * unit + np.minimum(data, 0.0).sum())


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10**6), st.floats(0.02, 0.98))
def test_cut_is_the_total_variation_of_the_indicator_and_the_polygon_of_midpoints(seed: int, share: float) -> None:
    region = np.random.default_rng(seed).random(OPERATOR.vertex_count) < share
    cut = edge_cut(OPERATOR)
    expected = total_variation(OPERATOR, region.astype(float))
    assert cut.weights.min() >= 0.0
    assert cut.perimeter(region) == pytest.approx(expected, rel=1e-12)
    assert perimeters(OPERATOR, region.astype(float), np.array([0.5]))[0] == pytest.approx(expected, rel=1e-12)


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10**6), st.integers(0, 2))
def test_best_threshold_is_the_least_of_all(seed: int, digits: int) -> None:
    """Against the total variation of every level set, written out, with ties among the values."""
    rng = np.random.default_rng(seed)
    values, slope = rng.normal(size=OPERATOR.vertex_count).round(digits), 20 * rng.normal(size=OPERATOR.vertex_count)
    best = best_threshold(edge_cut(OPERATOR), OPERATOR.mass, slope, values, "noise")
    energies = []
    for level in (-np.inf, *np.unique(values)):
        indicator = (values > level).astype(float)
        energies.append(total_variation(OPERATOR, indicator) + OPERATOR.mass @ (slope * indicator))
    assert best.energy == pytest.approx(min(energies), rel=1e-10, abs=1e-10)
    assert (best.region == (values > best.threshold)).all()
    indicator = best.region.astype(float)
    again = total_variation(OPERATOR, indicator) + OPERATOR.mass @ (slope * indicator)
    assert again == pytest.approx(best.energy, rel=1e-10, abs=1e-10)


@pytest.mark.parametrize(("shift", "name"), [(-1e3, "the full field"), (1e3, "the empty field")])
def test_trivial_labellings_have_their_names(shift: float, name: str) -> None:
    slope = shift + np.random.default_rng(0).normal(size=OPERATOR.vertex_count)
    best = best_threshold(edge_cut(OPERATOR), OPERATOR.mass, slope, -slope, "noise")
    assert best.name == name and best.region.all() == (shift < 0) and best.region.any() == (shift < 0)


@settings(deadline=None, max_examples=3)
@given(st.integers(0, 10**6), st.sampled_from([1.0, 5.0, 20.0]))
def test_lower_bound_is_below_the_least_of_all_labellings(seed: int, weight: float) -> None:
    """lower bound <= energy of phi <= least cut <= best level set of phi, the last two of labellings alone."""
    operator = fem(icosphere(3).mesh)
    rng = np.random.default_rng(seed)
    slope = weight * (
        np.sin(4 * rng.normal(size=3) @ icosphere(3).mesh.vertices.T) + rng.normal(size=operator.vertex_count)
    )
    solution = primal_dual(convex_chan_vese(operator.mass, slope), operator, tolerance=1e-6)
    exact = least_cut(operator, slope)
    level_set = best_threshold(edge_cut(operator), operator.mass, slope, solution.values, "phi").energy
    assert solution.lower_bound is not None
    rounding = 1e-5 * float(operator.mass @ np.abs(slope))
    assert solution.lower_bound <= exact + rounding and exact <= level_set + rounding
    assert solution.energy <= exact + rounding
