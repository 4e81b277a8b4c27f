"""Iterations of the neighbour mean are as wide as a Gaussian of the same name."""

import numpy as np
import pytest

from surfexp.mesh.shapes.rectangle import rectangle
from surfexp_studies.smoothing.carried_over_mask import iterations_as_wide

FLAT = rectangle(41, 41, 2.0, 2.0).mesh


def test_iterations_of_the_neighbour_mean_are_as_wide_as_they_should() -> None:
    """The variance of an impulse on a plane after that many means is that of the Gaussian, by its second moment."""
    from surfexp.smoothing.neighbour_mean import neighbour_mean

    width = 0.4
    steps = iterations_as_wide(FLAT, width)
    impulse = np.zeros(41 * 41)
    centre = int(np.argmin(((FLAT.vertices[:, :2] - 1.0) ** 2).sum(axis=1)))
    impulse[centre] = 1.0
    spread = neighbour_mean(FLAT.faces, impulse, steps)
    moment = float(spread @ ((FLAT.vertices - FLAT.vertices[centre]) ** 2).sum(axis=1) / spread.sum())
    assert moment == pytest.approx(2.0 * width**2 / (8.0 * np.log(2.0)), rel=0.1)
