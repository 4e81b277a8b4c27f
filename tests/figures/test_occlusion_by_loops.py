"""The occlusion of whole rows is that of one pixel after the other, at the edges of the picture and beside nothing too."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.figures.ambient_occlusion import BIAS, DIRECTIONS, STEPS, ambient_occlusion


def by_loops(depth: np.ndarray, normals: np.ndarray, radius: float, nearest: float) -> np.ndarray:
    height, width = depth.shape
    result = np.zeros((height, width))
    for row, column in np.argwhere(np.isfinite(depth)):
        for direction in range(DIRECTIONS):
            angle = 2.0 * np.pi * (direction + 0.5) / DIRECTIONS
            steepest = 0.0
            for step in range(STEPS):
                length = nearest + (radius - nearest) * (step / STEPS) ** 1.5
                dx, dy = round(length * np.cos(angle)), round(length * np.sin(angle))
                i, j = row + dy, column + dx
                if not (0 <= i < height and 0 <= j < width and np.isfinite(depth[i, j])):
                    continue
                way = np.array([dx, -dy, depth[row, column] - depth[i, j]])
                above, distance = normals[row, column] @ way, np.linalg.norm(way)
                if distance < radius and above > 0.0:
                    steepest = max(steepest, (above / distance - BIAS) * (1.0 - distance**2 / radius**2))
            result[row, column] += steepest / DIRECTIONS
    return result


@pytest.mark.parametrize("seed", range(4))
def test_rows_at_once_are_pixels_one_by_one(seed: int) -> None:
    random = np.random.default_rng(seed)
    depth = random.normal(0.0, 3.0, (19, 26))
    depth[random.random(depth.shape) < 0.2] = np.inf
    depth[7] = np.inf
    normals = random.normal(size=(*depth.shape, 3))
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    found = ambient_occlusion(depth, normals, 9.0, 1.5)
    np.testing.assert_allclose(found, by_loops(depth, normals, 9.0, 1.5), rtol=0, atol=1e-12)
    assert found.max() > 0.2 and (found[~np.isfinite(depth)] == 0.0).all()
