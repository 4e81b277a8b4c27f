"""The Gaussian of geodesic distances against the plane, where it is known."""

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.smoothing.geodesic_gaussian import geodesic_gaussian, near_distances
from surfexp.smoothing.methods import heat_time
from surfexp.variational.surface_flows import heat_flow

FLAT = rectangle(41, 41, 2.0, 2.0).mesh


def test_distances_of_a_grid_are_those_of_its_eight_directions() -> None:
    """On squares with both diagonals: the longer side and sqrt(2) - 1 times the shorter one, up to 8 % too long."""
    found = near_distances(FLAT, 0.5).tocoo()
    sides = np.sort(np.abs(FLAT.vertices[found.row] - FLAT.vertices[found.col])[:, :2], axis=1)
    assert found.data == pytest.approx(sides[:, 1] + (np.sqrt(2.0) - 1.0) * sides[:, 0])
    apart = found.data > 0
    assert (found.data[apart] / np.linalg.norm(sides[apart], axis=1)).max() < 1.0 / np.cos(np.pi / 8.0) + 1e-9


@pytest.mark.parametrize("angle", [np.pi, 2.0, 0.5])
def test_the_diagonal_of_a_folded_square_is_unfolded(angle: float) -> None:
    """One corner of a square is turned about the diagonal that is an edge; lengths on the surface stay."""
    axis = np.array([-1.0, 1.0, 0.0]) / np.sqrt(2.0)
    flat, lifted = np.array([-0.5, -0.5, 0.0]), np.cross(axis, [-0.5, -0.5, 0.0])
    corner = np.array([0.5, 0.5, 0.0]) + np.cos(angle) * flat + np.sin(angle) * lifted
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], corner])
    found = near_distances(TriangleMesh(points, np.array([[0, 1, 2], [1, 3, 2]])), 10.0).toarray()
    assert found[0, 3] == pytest.approx(np.sqrt(2.0))
    assert found[1, 2] == pytest.approx(np.sqrt(2.0))
    assert found == pytest.approx(found.T)


@pytest.mark.parametrize("beyond", [-0.5, 1.5])
def test_a_diagonal_that_leaves_its_triangles_is_none(beyond: float) -> None:
    """Two triangles on one edge whose tips lie beyond one of its ends: the way from tip to tip bends at that end."""
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [beyond, 0.5, 0.0], [beyond, -0.5, 0.0]])
    found = near_distances(TriangleMesh(points, np.array([[0, 1, 2], [1, 0, 3]])), 10.0).toarray()
    assert found[2, 3] == pytest.approx(2.0 * np.hypot(0.5, 0.5))


def test_a_limit_is_kept_and_nothing_below_it_is_lost() -> None:
    sphere = icosphere(3).mesh
    some, all_of_them = near_distances(sphere, 0.7).toarray(), near_distances(sphere, 10.0).toarray()
    near = all_of_them <= 0.7
    assert np.allclose(some[near], all_of_them[near])
    assert not some[~near].any()


def test_it_agrees_with_heat_flow_inside_a_plane() -> None:
    operator = fem(FLAT)
    bump = np.exp(-((FLAT.vertices[:, :2] - 1.0) ** 2).sum(axis=1) / 0.1)
    width = 0.3
    flow = heat_flow(operator, bump, heat_time(width), 50)
    mean = geodesic_gaussian(near_distances(FLAT, 1.7 * width), operator.mass, bump, width)
    inside = (np.abs(FLAT.vertices[:, :2] - 1.0) < 0.5).all(axis=1)
    assert np.abs(mean - flow)[inside].max() < 0.02


def test_constants_stay_and_nothing_leaves_its_range() -> None:
    operator = fem(FLAT)
    distances = near_distances(FLAT, 0.5)
    assert geodesic_gaussian(distances, operator.mass, np.ones((41 * 41, 2)), 0.3) == pytest.approx(1.0)
    values = np.random.default_rng(0).uniform(-1.0, 1.0, 41 * 41)
    assert np.abs(geodesic_gaussian(distances, operator.mass, values, 0.3)).max() < 1.0


def test_refusals() -> None:
    with pytest.raises(ValueError, match="limit is 0"):
        near_distances(FLAT, 0.0)
    with pytest.raises(ValueError, match="width is -1"):
        geodesic_gaussian(near_distances(FLAT, 0.1), fem(FLAT).mass, np.ones(41 * 41), -1.0)
