"""Correlation lengths that vary along a surface."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp_studies.nulls.planted_length import widths_along


def test_widths_grow_as_a_geometric_sequence() -> None:
    line = np.column_stack([np.zeros(3), [1.0, 2.0, 3.0], [5.0, 0.0, 2.0]])
    np.testing.assert_allclose(widths_along(line, 10.0, 4.0), [5.0, 10.0, 20.0])
    np.testing.assert_allclose(widths_along(line, 10.0, 4.0, axis=2)[:2], [20.0, 5.0])
    np.testing.assert_array_equal(widths_along(line, 10.0, 1.0), 10.0)
    for width, ratio, axis in ((0.0, 3.0, 1), (1.0, 0.5, 1), (1.0, 3.0, 0)):
        with pytest.raises(ValueError, match="a positive width, a ratio of 1 or more"):
            widths_along(line, width, ratio, axis)
