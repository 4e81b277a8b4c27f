"""Counterexamples to the published metric, the distances that hold, and growth on analytic spectra."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from surfexp.embedding.analytic_spectra import sphere_embedding, spheroid_embedding, torus_embedding
from surfexp.embedding.distance_methods import (
    Pairing,
    gap_metrics,
    pairwise_distances,
    triangle_metrics,
    unproved_pairs,
)
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, spectral_embedding
from surfexp.embedding.sup_inf import block_group, refines, sup_inf_distance
from surfexp.mesh.shapes.counterexamples import clover, named_revolution
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs


def embed(surface: Surface, n: int) -> SpectralEmbedding:
    elements = surface_elements(surface.mesh)
    return spectral_embedding(eigenpairs(elements.stiffness, elements.mass, n + 1), surface.mesh.vertex_areas, n)


@pytest.fixture(scope="module")
def revolutions() -> dict[str, SpectralEmbedding]:
    return {name: embed(named_revolution(name), 1) for name in ("cigar", "needle_ball", "two_balls")}


@pytest.fixture(scope="module")
def clovers() -> dict[str, SpectralEmbedding]:
    squeezed = {"a": (0.03, 0.0), "double": (0.0, 0.0), "c": (0.03, 30.0)}
    return {name: embed(clover(3, squeeze=share, angle=angle), 2) for name, (share, angle) in squeezed.items()}


def test_the_mean_hausdorff_distance_breaks_the_triangle_and_the_true_metrics_do_not(revolutions) -> None:
    ratios = {
        method: triangle_metrics(pairwise_distances(revolutions, Pairing(method, samples=150))[0])["triangle_ratio"]
        for method in ("mean_hausdorff", "hausdorff", "wasserstein")
    }
    assert ratios["mean_hausdorff"] > 3.0
    assert ratios["hausdorff"] <= 1.0 + 1e-9 and ratios["wasserstein"] <= 1.0 + 1e-9


def test_a_double_eigenvalue_breaks_the_triangle_and_the_sup_inf_mends_it(clovers) -> None:
    first, second, third = (embedding.values for embedding in clovers.values())
    assert second[1] / second[0] < 1.005 < 1.03 < first[1] / first[0]
    assert first == pytest.approx(third, rel=2e-3)
    ratios = {
        method: triangle_metrics(pairwise_distances(clovers, Pairing(method, samples=200, gap=0.01))[0])[
            "triangle_ratio"
        ]
        for method in ("least_over_blocks", "sup_inf")
    }
    assert ratios["least_over_blocks"] > 1.5
    assert ratios["sup_inf"] <= 1.0


def test_the_needle_ball_covers_the_range_of_the_others(revolutions) -> None:
    ranges = {name: np.ptp(embedding.points) for name, embedding in revolutions.items()}
    assert ranges["needle_ball"] > ranges["two_balls"] > ranges["cigar"]


def test_triangle_metrics_by_hand() -> None:
    matrix = np.array([[0.0, 1.0, 3.0], [1.0, 0.0, 1.0], [3.0, 1.0, 0.0]])
    found = triangle_metrics(matrix)
    assert found["triangle_ratio"] == pytest.approx(1.5) and found["triangles_broken"] == pytest.approx(1 / 3)
    assert triangle_metrics(matrix[:2, :2]) == {"triangle_ratio": 0.0, "triangles_broken": 0.0}


@pytest.mark.parametrize("method", ["hausdorff", "wasserstein", pytest.param("sup_inf", marks=pytest.mark.slow)])
def test_random_triples_of_tori_obey_the_triangle(method: str) -> None:
    rng = np.random.default_rng(0)
    shapes = {str(k): torus_embedding(float(ratio), 3, 12) for k, ratio in enumerate(rng.uniform(1.1, 3.0, 16))}
    values, bounds = pairwise_distances(shapes, Pairing(method, samples=60, gap=0.0))
    # 560 triples, more than the 500 that were asked for
    assert len(list(combinations(shapes, 3))) == 560
    assert triangle_metrics(values)["triangles_broken"] == 0.0
    assert values.min() >= 0.0 and (np.diag(values) == 0.0).all() and np.array_equal(values, values.T)
    assert values[np.tril_indices(16, -1)].min() > 0.0
    assert gap_metrics(values, bounds)["proved"] == (0.0 if method == "sup_inf" else 1.0)


def test_gaps_by_hand() -> None:
    values, bounds = np.array([[0.0, 2.0, 4.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]), np.zeros((3, 3))
    bounds[1, 0] = bounds[0, 1] = 1.5
    bounds[2, 0] = bounds[0, 2] = 4.0
    assert gap_metrics(values, bounds) == pytest.approx({"proved": 2 / 3, "mean gap": 0.25 / 3, "largest gap": 0.25})
    assert unproved_pairs("abc", values, bounds) == (
        "a to b: 2.0000 is the best found, at least 1.5000 is proved, a gap of 25 %.",
    )
    assert gap_metrics(values[:1, :1], bounds[:1, :1])["proved"] == 1.0


def test_groups_of_bases() -> None:
    group = block_group(((0, 1), (1, 3)), angles=6)
    assert len(group) == 2 * 12
    # closed under products: six turns of the plane, each with a reflection
    products = np.array([first @ second for first in group for second in group])
    assert cdist(products.reshape(-1, 9), np.reshape(group, (-1, 9))).min(axis=1).max() < 1e-12
    for matrix in group:
        assert matrix @ matrix.T == pytest.approx(np.eye(3), abs=1e-12)
        assert np.abs(matrix[0, 1:]).max() == 0.0
    assert refines(((0, 1), (1, 2)), ((0, 2),)) and not refines(((0, 2),), ((0, 1), (1, 2)))
    with pytest.raises(ValueError, match="take fewer angles"):
        block_group(((0, 2), (2, 4), (4, 6)), angles=24)


def test_the_sup_inf_of_simple_spectra_is_the_least_over_signs(revolutions) -> None:
    first, second = (revolutions[name].sample(100, 0) for name in ("cigar", "two_balls"))
    simple = ((0, 1),)
    expected = spectral_distance(first, second, summary="largest").value
    assert sup_inf_distance(first, second, simple, simple) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("summary", ["largest", "mean"])
def test_the_sup_inf_leaves_out_only_bases_that_cannot_matter(summary: str) -> None:
    rng = np.random.default_rng(2)
    spread = np.array([1.0, 0.3])
    first, second = (
        SpectralEmbedding(rng.normal(size=(count, 2)) * spread, np.full(count, 1.0 / count), np.array([8.0, 8.1]))
        for count in (15, 18)
    )
    plane, lines = ((0, 2),), ((0, 1), (1, 2))
    for blocks in ((plane, lines), (lines, plane), (plane, plane), (lines, lines)):
        groups = [block_group(own, angles=8) for own in blocks]
        tables = {
            (i, j): cdist(first.points @ a, second.points @ b)
            for i, a in enumerate(groups[0])
            for j, b in enumerate(groups[1])
        }
        there = np.empty((len(groups[0]), len(groups[1])))
        back = np.empty_like(there)
        for place, table in tables.items():
            nearest = table.min(axis=1), table.min(axis=0)
            if summary == "largest":
                there[place] = back[place] = max(nearest[0].max(), nearest[1].max())
            else:
                there[place], back[place] = nearest[0].mean(), nearest[1].mean()
        expected = max(there.min(axis=1).max(), back.min(axis=0).max())
        assert sup_inf_distance(first, second, *blocks, summary, angles=8) == pytest.approx(expected, rel=1e-9)


def test_analytic_embeddings_agree_with_each_other_and_with_elements() -> None:
    sphere, round_one = sphere_embedding(24, 1500), spheroid_embedding(1.0, 24)
    assert round_one.values == pytest.approx(sphere.values, rel=1e-4)
    for embedding in (sphere, round_one, torus_embedding(1.3, 24)):
        gram = (embedding.points * embedding.weights[:, None]).T @ embedding.points
        assert gram * np.sqrt(np.outer(embedding.values, embedding.values)) == pytest.approx(np.eye(24), abs=0.02)
    # a mirror at the equator turns the order of the points around
    flat = spheroid_embedding(0.7, 5).weights
    assert flat == pytest.approx(flat[::-1], rel=1e-12)
    assert torus_embedding(1.0, 4).values == pytest.approx(4.0 * np.pi**2)
    from surfexp.mesh.shapes.ellipsoid import ellipsoid

    meshed = embed(ellipsoid(4, (1.0, 1.0, 0.8)), 8)
    assert meshed.values == pytest.approx(spheroid_embedding(0.8, 8).values, rel=0.01)


SENSELESS = (
    lambda: torus_embedding(0.0, 5),
    lambda: spheroid_embedding(-1.0, 5),
    lambda: clover(3, 2),
    lambda: named_revolution("egg"),
)


@pytest.mark.parametrize("make", SENSELESS)
def test_senseless_shapes_are_refused(make) -> None:
    with pytest.raises(ValueError, match=r"take a positive one|are needed|unknown, choose one of"):
        make()
