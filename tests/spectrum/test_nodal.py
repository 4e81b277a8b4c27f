"""Nodal domains: exact counts on separable shapes, agreement with scipy, invariances, Courant's bound."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.special import jn_zeros

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.nodal_domains import (
    cluster_averaged_counts,
    courant_violations,
    filtered_nodal_counts,
    nodal_counts,
    nodal_thresholds,
)
from surfexp.spectrum.nodal_graph import element_faces, nodal_graph
from surfexp.spectrum.soft_nodal_counts import soft_nodal_counts

WIDTH = float(np.sqrt(2.1))


def counted(elements, k: int):
    """Eigensystem, raw, filtered and soft counts of the first k modes."""
    system = eigenpairs(elements.stiffness, elements.mass, k)
    functions = elements.extend(system.vectors)
    graph = nodal_graph(element_faces(elements.nodes), elements.nodes.count)
    saddles, peaks = nodal_thresholds(np.maximum(system.values, 1e-3), elements.area, elements.nodes.count)
    soft = soft_nodal_counts(graph, functions, saddles, peaks)
    return system, nodal_counts(graph, functions), filtered_nodal_counts(graph, functions, saddles, peaks), soft


def rectangle_counts(k: int, first: int, width: float = WIDTH) -> np.ndarray:
    m, n = np.meshgrid(np.arange(first, 40), np.arange(first, 40), indexing="ij")
    order = np.argsort(((m / width) ** 2 + n**2).ravel())[:k]
    return ((m - first + 1) * (n - first + 1)).ravel()[order]


def test_rectangle_counts_are_exact_with_the_filter() -> None:
    mesh = rectangle(61, 41, WIDTH, 1.0).mesh
    for boundary, first in (("dirichlet", 1), ("neumann", 0)):
        exact = rectangle_counts(60, first)
        _, raw, filtered, soft = counted(surface_elements(mesh, 2, boundary=boundary), 60)
        assert (filtered == exact).all()
        assert (raw == exact).sum() < 35
        assert np.abs(soft - exact).mean() < 0.2 < 5.0 < np.abs(raw - exact).mean()
        linear = counted(surface_elements(mesh, 1, boundary=boundary), 60)[2]
        assert (linear[:20] == exact[:20]).all() and (linear == exact).sum() >= 52


def test_filter_set_on_the_rectangle_scores_on_a_disk_and_a_rotated_irregular_rectangle() -> None:
    # disk, Dirichlet: modes cos(m phi) J_m(j_mn r) have max(1, 2 m) n domains
    project = lambda points: points / np.linalg.norm(points, axis=1, keepdims=True)  # noqa: E731
    filtered = counted(surface_elements(disk(30).mesh, 2, project_boundary=project, boundary="dirichlet"), 40)[2]
    known = sorted(
        (float(zero**2), max(1, 2 * m) * (n + 1)) for m in range(12) for n, zero in enumerate(jn_zeros(m, 6))
    )
    exact = np.concatenate([[count] * (1 if count == 1 or system_is_radial(value) else 2) for value, count in known])[
        :40
    ]
    assert (filtered == exact).sum() >= 38
    # another aspect, jittered inside, rotated
    mesh, rng = rectangle(55, 45, 1.23, 1.0).mesh, np.random.default_rng(0)
    inner = np.setdiff1d(np.arange(len(mesh.vertices)), np.concatenate(mesh.boundary_loops))
    vertices = mesh.vertices.copy()
    vertices[inner, :2] += rng.uniform(-0.2, 0.2, (len(inner), 2)) / 45
    turn = np.array([[np.cos(0.7), -np.sin(0.7), 0.0], [np.sin(0.7), np.cos(0.7), 0.0], [0.0, 0.0, 1.0]])
    _, raw, filtered, _ = counted(
        surface_elements(TriangleMesh(vertices @ turn.T, mesh.faces), 2, boundary="dirichlet"), 60
    )
    exact = rectangle_counts(60, 1, 1.23)
    assert (filtered == exact).sum() >= 56 > 35 > (raw == exact).sum()


def system_is_radial(value: float) -> bool:
    return bool(np.isclose(np.sqrt(value), jn_zeros(0, 8), rtol=1e-12).any())


def test_counts_and_labels_equal_scipy() -> None:
    mesh = icosphere(3).mesh
    graph = nodal_graph(mesh.faces, 642)
    functions = np.random.default_rng(0).normal(size=(642, 12))
    counts = nodal_counts(graph, functions)
    for c in range(12):
        same = (functions[mesh.edges[:, 0], c] > 0) == (functions[mesh.edges[:, 1], c] > 0)
        kept = mesh.edges[same]
        adjacency = coo_array((np.ones(len(kept)), (kept[:, 0], kept[:, 1])), shape=(642, 642))
        number, _ = connected_components(adjacency, directed=False)
        assert counts[c] == number


def test_courants_bound() -> None:
    ball = icosphere(4).mesh
    mesh = TriangleMesh(ball.vertices * [1.3, 1.0, 0.7], ball.faces)
    _, raw, filtered, soft = counted(surface_elements(mesh), 60)
    assert raw[0] == filtered[0] == 1 and raw[1] == filtered[1] == 2
    assert soft[:2] == pytest.approx([1.0, 2.0], abs=0.05)
    assert len(courant_violations(filtered)) == 0
    assert courant_violations(np.array([1, 2, 5, 4])).tolist() == [2]


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 1000), st.floats(0.1, 10.0))
def test_counts_do_not_change_with_scale_sign_or_numbering(seed: int, scale: float) -> None:
    mesh = icosphere(2).mesh
    rng = np.random.default_rng(seed)
    functions = rng.normal(size=(162, 3))
    levels = rng.uniform(0.05, 0.5, 3)
    graph = nodal_graph(mesh.faces, 162)
    shuffle = rng.permutation(162)
    shuffled = nodal_graph(np.argsort(shuffle)[mesh.faces], 162)
    hard = filtered_nodal_counts(graph, functions, levels, 2 * levels)
    soft = soft_nodal_counts(graph, functions, levels, 2 * levels)
    for other, factor in ((functions, scale), (-functions, scale)):
        assert np.array_equal(filtered_nodal_counts(graph, factor * other, factor * levels, 2 * factor * levels), hard)
    assert np.array_equal(filtered_nodal_counts(shuffled, functions[shuffle], levels, 2 * levels), hard)
    assert np.allclose(
        soft_nodal_counts(shuffled, -scale * functions[shuffle], scale * levels, 2 * scale * levels), soft
    )


def test_soft_counts_are_continuous_where_filtered_ones_jump() -> None:
    mesh = rectangle(41, 41, 1.0, 1.0).mesh
    graph = nodal_graph(mesh.faces, 1681)
    x, y = (mesh.vertices[:, :2] - 0.5).T
    tilts = np.linspace(-0.06, 0.06, 61)
    functions = 4.0 * x[:, None] * y[:, None] + tilts
    widths = np.full(61, 0.03)
    soft = soft_nodal_counts(graph, functions, widths, 2.0 * widths)
    hard = filtered_nodal_counts(graph, functions, widths, 2.0 * widths)
    assert hard[30] == 4 and hard[0] == hard[-1] == 3
    assert soft[[0, 30, 60]] == pytest.approx([3.0, 4.0, 3.0], abs=1e-6)
    assert np.abs(np.diff(soft)).max() < 0.1 < np.abs(np.diff(hard)).max()


def test_clusters_are_averaged_over_their_bases() -> None:
    elements = surface_elements(icosphere(3).mesh)
    system = eigenpairs(elements.stiffness, elements.mass, 25)
    assert system.clusters[:2] == ((1, 4), (4, 9))
    graph = nodal_graph(icosphere(3).mesh.faces, 642)
    thresholds = nodal_thresholds(system.values, elements.area, 642)
    mean, deviation = cluster_averaged_counts(graph, system, *thresholds)
    assert mean[0] == 1.0 and deviation[0] == 0.0
    assert (mean[1:4] == 2.0).all() and (deviation[1:4] == 0.0).all()  # a plane cuts the sphere in two
    assert deviation[9:].max() > 0.3  # the counts of higher harmonics depend on the basis
    assert all(np.ptp(mean[start:stop]) == 0.0 for start, stop in system.clusters)
    again = cluster_averaged_counts(graph, system, *thresholds)
    assert np.array_equal(mean, again[0]) and np.array_equal(deviation, again[1])


def test_sizes_must_agree() -> None:
    graph = nodal_graph(icosphere(1).mesh.faces, 42)
    with pytest.raises(ValueError, match="41 rows, the graph has 42"):
        nodal_counts(graph, np.ones((41, 2)))
    with pytest.raises(ValueError, match="must be positive"):
        soft_nodal_counts(graph, np.ones((42, 1)), np.zeros(1), np.ones(1))


def test_a_bump_below_the_peak_threshold_is_no_domain() -> None:
    mesh = rectangle(21, 21, 1.0, 1.0).mesh
    graph = nodal_graph(mesh.faces, 441)
    function = mesh.vertices[:, :1] + 0.1
    function[220] = -0.05
    level = np.array([0.02])
    assert nodal_counts(graph, function).tolist() == [2]
    assert filtered_nodal_counts(graph, function, level, np.array([0.04])).tolist() == [2]
    assert filtered_nodal_counts(graph, function, level, np.array([0.06])).tolist() == [1]
