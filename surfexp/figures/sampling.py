"""Supersampling: the pixels of a picture as blocks of samples."""

from __future__ import annotations

from functools import reduce

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.triangle_mesh import Floats, Integers


class Blocks:
    """Squares of factor x factor samples, one for each pixel.

    Parameters
    ----------
    covered : (factor * height, factor * width) bool
        Samples that carry values; the others count as zero.
    factor : int
    """

    def __init__(self, covered: NDArray[np.bool_], factor: int) -> None:
        self.factor = factor
        self.height, self.width = covered.shape[0] // factor, covered.shape[1] // factor
        row, column = np.nonzero(covered)
        self._pixel: Integers = (row // factor) * self.width + column // factor

    def mean(self, values: Floats) -> Floats:
        """(height, width, k) averages over the blocks of values (p, k) at the covered samples in reading order."""
        count = self.height * self.width
        sums = [np.bincount(self._pixel, channel, count) for channel in values.T]
        return np.stack(sums, axis=1).reshape(self.height, self.width, -1) / self.factor**2

    def least(self, samples: Floats) -> Floats:
        """(height, width) smallest of the samples of each block, of a picture of all samples."""
        step = self.factor
        return reduce(np.minimum, [samples[i::step, j::step] for i in range(step) for j in range(step)])
