"""A small torus and noisy images on it."""

import numpy as np
import pytest

from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image


@pytest.fixture(scope="session")
def surface() -> Surface:
    return torus(36, 18, jitter=0.15, seed=2)


@pytest.fixture(scope="session")
def image(surface: Surface) -> Image:
    """Two phases, 0 and 255, with noise of 40."""
    rng = np.random.default_rng(0)
    u, v = surface.coordinates.T
    inside = np.sin(2 * u) * np.cos(v) > -0.1
    clean = np.where(inside, 255.0, 0.0)
    known = rng.random(len(clean)) < 0.8
    noisy = clean + rng.normal(0, 40, len(clean))
    return Image(noisy, "two phases", clean=clean, noise=40.0, known=known, labels={"bright": inside})
