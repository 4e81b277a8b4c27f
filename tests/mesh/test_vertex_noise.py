"""Noise on vertices."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shapes.cube import cube
from surfexp.mesh.shapes.icosphere import icosphere


def test_noise_has_its_standard_deviation_and_seed() -> None:
    clean = cube(40)
    noisy, again, other = (add_vertex_noise(clean, 0.1, seed) for seed in (1, 1, 2))
    shift = noisy.mesh.vertices - clean.mesh.vertices
    assert shift.std(axis=0) == pytest.approx(0.1, rel=0.03)
    assert (noisy.mesh.vertices == again.mesh.vertices).all()
    assert not np.allclose(noisy.mesh.vertices, other.mesh.vertices)
    assert (noisy.scalars["side"] == clean.scalars["side"]).all()
    assert noisy.metrics["minimum_angle"] == noisy.mesh.minimum_angle < clean.metrics["minimum_angle"]
    assert "0.1 (seed 1, direction: all)" in noisy.notes[0]


def test_normal_noise_moves_along_the_normals_only() -> None:
    sphere = icosphere(4)
    shift = add_vertex_noise(sphere, 0.02, 5, "normal").mesh.vertices - sphere.mesh.vertices
    assert np.cross(shift, sphere.mesh.vertex_normals) == pytest.approx(0.0, abs=1e-15)
    assert (shift * sphere.mesh.vertex_normals).sum(axis=1).std() == pytest.approx(0.02, rel=0.05)


def test_bad_options_are_named() -> None:
    with pytest.raises(ValueError, match=r"sigma = -0\.1"):
        add_vertex_noise(cube(2), -0.1)
    with pytest.raises(ValueError, match="'up'"):
        add_vertex_noise(cube(2), 0.1, direction="up")  # type: ignore[arg-type]


@pytest.mark.parametrize("direction", ["all", "normal"])
def test_noise_has_mean_zero_and_the_deviation_that_it_says(direction: str) -> None:
    clean = icosphere(4)
    noisy = add_vertex_noise(clean, 0.01, seed=3, direction=direction)  # type: ignore[arg-type]
    shift = noisy.mesh.vertices - clean.mesh.vertices
    along = shift if direction == "all" else (shift * clean.mesh.vertex_normals).sum(axis=1)
    assert abs(along.mean()) < 5 * 0.01 / np.sqrt(along.size) and along.std() == pytest.approx(0.01, rel=0.05)
