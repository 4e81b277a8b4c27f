"""Distances by few points of each surface: bounds that hold for all points, values that are those of all points."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

import surfexp as sx
from surfexp.embedding.representatives import distance_by_representatives, matched, represented
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.distances import REPRESENTATIVES, represented_pair

BODY = sx.shape("ellipsoid", levels=4, semiaxes=(1.0, 1.3, 1.9))


def cloud(count: int, seed: int) -> SpectralEmbedding:
    random = np.random.default_rng(seed)
    points = random.normal(size=(count, 3)) / (1.0 + np.arange(3))
    weights = random.uniform(0.1, 1.0, count)
    return SpectralEmbedding(points, weights / weights.sum(), np.arange(1.0, 4.0))


def ring(count: int) -> csr_array:
    rows = np.arange(count)
    pairs = np.concatenate([rows, rows]), np.concatenate([np.roll(rows, 1), np.roll(rows, -1)])
    return csr_array((np.ones(2 * count, np.int8), pairs), shape=(count, count))


def dented(amount: float) -> sx.Surface:
    vertices = BODY.mesh.vertices.copy()
    vertices[:, 2] *= 1.0 + amount * vertices[:, 0]
    return sx.Surface(TriangleMesh(vertices, BODY.mesh.faces), "dented")


@given(st.integers(0, 10**6), st.integers(2, 90), st.integers(2, 90))
def test_bounds_hold_for_all_points(seed: int, few: int, other: int) -> None:
    source, target = cloud(150, seed), cloud(130, seed + 1)
    exact = spectral_distance(source, target)
    found = distance_by_representatives(
        represented(source, few), represented(target, other), (ring(150), ring(130)), spectral_distance
    )
    assert exact.optimal and found.lower_bound <= exact.value + 1e-12
    assert found.value >= exact.value - 1e-12
    assert not found.optimal and len(found.closed) == 0


@pytest.mark.parametrize("count", [1, 20, 200, 999, 1000, 5000])
def test_each_point_is_near_its_representative(count: int) -> None:
    whole = cloud(1000, 3)
    found = represented(whole, count)
    apart, owner = cKDTree(found.few.points).query(whole.points)
    assert np.array_equal(found.few.points, whole.points[found.rows])
    assert found.radius == pytest.approx(apart.max()) and found.mean == pytest.approx(apart @ whole.weights)
    assert found.few.weights == pytest.approx(np.bincount(owner, whole.weights))
    if count >= 1000:
        assert np.array_equal(found.rows, np.arange(1000)) and found.radius == 0.0
    assert np.array_equal(found.rows, represented(whole, count).rows)


def test_about_as_many_as_asked_for_stand_for_a_surface() -> None:
    from surfexp.tasks.embedded_surface import embedded

    whole, _ = embedded(BODY, 10, "biharmonic")
    for count in (50, 100, 200, 400, 1000):
        found = represented(whole, count)
        assert 0.8 * count < len(found.rows) < 1.4 * count
        # none lies in the radius of another, within which all points lie
        spread = cKDTree(found.few.points).query(found.few.points, 2)[0][:, 1]
        assert spread.min() > 0.99 * found.radius


def test_along_all_edges_the_nearest_point_is_found() -> None:
    points, others = np.random.default_rng(0).normal(size=(2, 40, 4))
    everywhere = csr_array(np.ones((40, 40), np.int8))
    rows, distances = matched(points, everywhere, others, everywhere)
    exact, nearest = cKDTree(others).query(points)
    assert np.array_equal(rows, nearest) and distances == pytest.approx(exact)


def test_a_renumbered_copy_is_at_distance_zero_and_every_vertex_finds_its_twin() -> None:
    order = np.random.default_rng(2).permutation(len(BODY.mesh.vertices))
    copy = sx.Surface(TriangleMesh(BODY.mesh.vertices[order], np.argsort(order)[BODY.mesh.faces]), "copy")
    found = sx.distance(lopsided(BODY), lopsided(copy), 6, points=300)
    assert found.value < 1e-6 and np.array_equal(found.correspondence, order)
    assert found.lower_bound == 0.0


def lopsided(surface: sx.Surface) -> sx.Surface:
    x, y, z = surface.mesh.vertices.T
    vertices = np.stack([x + 0.4 * y**2 + 0.3 * y * z, y + 0.3 * z**2, z * (1.0 + 0.3 * x)], axis=1)
    return sx.Surface(TriangleMesh(vertices, surface.mesh.faces), "lopsided")


OTHERS = {
    "slightly dented": dented(0.02),
    "dented": dented(0.3),
    "rounder": sx.shape("ellipsoid", levels=4, semiaxes=(1.0, 1.1, 1.2)),
    "longer": sx.shape("ellipsoid", levels=4, semiaxes=(1.0, 1.0, 4.0)),
}


@pytest.mark.parametrize("name", OTHERS)
def test_values_are_those_of_all_vertices(name: str) -> None:
    exact = sx.distance(BODY, OTHERS[name], 8)
    found = sx.distance(BODY, OTHERS[name], 8, points=500)
    assert exact.optimal and not found.optimal
    assert found.lower_bound <= exact.value <= found.value <= 1.001 * exact.value
    (note,) = [note for note in found.notes if "stand for the others" in note]
    assert f"of {len(BODY.mesh.vertices):,}" in note
    if name == "longer":  # the bound bites where surfaces are farther apart than points and their representatives
        assert found.lower_bound > 0.5 * exact.value


def test_many_points_are_represented_unless_all_are_asked_for() -> None:
    def line(count: int) -> SpectralEmbedding:
        return SpectralEmbedding(np.linspace(0.0, 1.0, count)[:, None], np.full(count, 1.0 / count), np.ones(1))

    assert [len(one.rows) for one in represented_pair(line(44_721), line(44_721))] == [44_721, 44_721]
    few = represented_pair(line(44_722), line(44_722))
    assert all(0.5 * REPRESENTATIVES < len(one.rows) < 1.5 * REPRESENTATIVES for one in few)
    assert [len(one.rows) for one in represented_pair(line(44_722), line(44_722), 50_000)] == [44_722, 44_722]


def test_modes_in_clusters_are_aligned_on_representatives_too() -> None:
    sphere = sx.shape("icosphere", levels=4)
    turned = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    other = sx.Surface(TriangleMesh(sphere.mesh.vertices @ turned.T, sphere.mesh.faces), "turned")
    found = sx.align(sphere, other, 3, points=400)
    whole = sx.align(sphere, other, 3)
    assert found.value < 1e-2 * np.linalg.norm(whole.vectors, axis=1).mean()
    assert any("stand for the others" in note for note in found.notes) and not whole.notes
    assert found.value >= found.lower_bound and not found.optimal
