"""Distances between random points: the exact distribution on a sphere, scale, motion, seed."""

import numpy as np
import pytest
from surfexp_shape_distributions.distances import distance_quantiles

import surfexp as sx

SPHERE = sx.shape("icosphere", levels=5).mesh
ELLIPSOID = sx.shape("ellipsoid").mesh


def test_the_distribution_on_a_sphere_is_the_exact_one() -> None:
    """The square of the distance of two points on the unit sphere is uniform on 0 to 4."""
    shares = (np.arange(50) + 0.5) / 50
    found = distance_quantiles(SPHERE.vertices, SPHERE.faces, 50, pairs=400_000)
    # by the inequality of Dvoretzky, Kiefer and Wolfowitz more has the probability 1e-6
    assert np.abs(found**2 / 4.0 - shares).max() < np.sqrt(np.log(2e6) / (2 * 400_000))


@pytest.mark.parametrize("factor", [1e-3, 1.0, 1e3])
def test_distances_scale_with_the_surface_and_do_not_see_where_it_lies(factor: float) -> None:
    """Seeded alike, a turned, moved and scaled surface has the same distances times the scale."""
    quarter_turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    moved = factor * (ELLIPSOID.vertices @ quarter_turn.T + [3.0, -1.0, 2.0])
    same = distance_quantiles(ELLIPSOID.vertices, ELLIPSOID.faces, 20, 10_000)
    assert distance_quantiles(moved, ELLIPSOID.faces, 20, 10_000) == pytest.approx(factor * same, rel=1e-9)


def test_a_seed_repeats_and_another_differs_little() -> None:
    """Equal to the bit, and within five hundredths."""
    first, again, other = (distance_quantiles(ELLIPSOID.vertices, ELLIPSOID.faces, 20, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert 0.0 < np.abs(first - other).max() < 0.05
