"""Views: directions, fit and equal scale."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.figures.camera import VIEWS, fit_camera, unit_camera, view_axes, viewing_direction
from surfexp.mesh.triangle_mesh import TriangleMesh

RANDOM = np.random.default_rng(0)
CLOUD = TriangleMesh(RANDOM.normal(size=(60, 3)) * [1.0, 2.0, 0.5] + [-5.0, 1.0, 2.0], RANDOM.integers(0, 60, (80, 3)))


@pytest.mark.parametrize("view", [*VIEWS.values(), (33.0, -71.0)])
def test_axes_are_a_rotation(view: tuple[float, float]) -> None:
    axes = view_axes(*view)
    assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(axes) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("view", "right", "up"),
    [
        ("left", [0, -1, 0], [0, 0, 1]),  # the front of a brain is on the left of its left side
        ("right", [0, 1, 0], [0, 0, 1]),
        ("front", [-1, 0, 0], [0, 0, 1]),
        ("back", [1, 0, 0], [0, 0, 1]),
        ("top", [1, 0, 0], [0, 1, 0]),
        ("bottom", [-1, 0, 0], [0, 1, 0]),
    ],
)
def test_named_views(view: str, right: list[int], up: list[int]) -> None:
    assert np.allclose(view_axes(*VIEWS[view])[:2], [right, up], atol=1e-15)


def test_lateral_is_the_outer_side_of_either_hemisphere() -> None:
    mirrored = TriangleMesh(CLOUD.vertices * [-1, 1, 1], CLOUD.faces)
    assert viewing_direction("lateral", CLOUD) == VIEWS["left"] == viewing_direction("medial", mirrored)
    barely = TriangleMesh(CLOUD.vertices - [CLOUD.vertices[:, 0].mean() - 0.01, 0.0, 0.0], CLOUD.faces)
    assert viewing_direction("lateral", barely) == VIEWS["right"]
    assert viewing_direction("medial", CLOUD) == VIEWS["right"] == viewing_direction("lateral", mirrored)


@pytest.mark.parametrize("field_of_view", [0.0, 25.0, 90.0])
@pytest.mark.parametrize("size", [(300, 200), (120, 400)])
def test_fit_touches_the_margin_and_is_centred(field_of_view: float, size: tuple[int, int]) -> None:
    camera = fit_camera(CLOUD, (20.0, 30.0), size, field_of_view, margin=0.05)
    screen, _, divisor = camera.project(CLOUD.vertices[np.unique(CLOUD.faces)])
    low, high = screen.min(axis=0), screen.max(axis=0)
    assert np.allclose(0.5 * (low + high), np.array(size) / 2.0)
    assert np.min(low) == pytest.approx(0.05 * min(size))
    assert (divisor > 0.0).all()


def test_perspective_tends_to_orthographic() -> None:
    def distance(angle: float) -> float:
        flat, deep = fit_camera(CLOUD), fit_camera(CLOUD, field_of_view=angle)
        return float(np.abs(flat.project(CLOUD.vertices)[0] - deep.project(CLOUD.vertices)[0]).max())

    assert 0.0 < distance(0.1) == pytest.approx(0.5 * distance(0.2), rel=0.05)


def test_up_is_up_and_near_is_less_deep() -> None:
    camera = fit_camera(CLOUD, (40.0, 10.0))
    screen, depth, _ = camera.project(camera.center + np.vstack([np.zeros(3), camera.axes]))
    middle, right, up, toward = screen
    assert right[0] > middle[0] and right[1] == pytest.approx(middle[1])
    assert up[1] < middle[1] and up[0] == pytest.approx(middle[0])
    assert np.allclose(toward, middle) and np.allclose(depth, [0.0, 0.0, 0.0, -1.0])


def test_given_scale_is_kept() -> None:
    camera = fit_camera(CLOUD, scale=7.0)
    a, b = camera.project(camera.center + np.array([[0.0] * 3, 3.0 * camera.axes[0]]))[0]
    assert np.allclose(b - a, [21.0, 0.0])


def test_bad_views_are_named() -> None:
    with pytest.raises(ValueError, match="'latteral' is unknown, choose 'lateral'"):
        unit_camera(CLOUD, "latteral")
    with pytest.raises(ValueError, match=r"120\.0 degrees"):
        unit_camera(CLOUD, field_of_view=120.0)
    with pytest.raises(ValueError, match="0 x 5"):
        fit_camera(CLOUD, size=(0, 5))
