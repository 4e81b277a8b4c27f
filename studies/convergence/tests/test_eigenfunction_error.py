"""Errors of eigenfunctions of linear elements, what midpoints gain, and values below the exact ones."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from surfexp_studies.convergence.eigenfunction_error import (
    _groups,
    eigenfunction_errors,
    midpoint_gain,
    shape_mesh,
    values_below,
)


@pytest.mark.parametrize("shape", ["sphere", "rectangle"])
def test_errors_are_of_second_order_and_grow_with_the_value(shape: str) -> None:
    coarse, fine = (eigenfunction_errors(shape, level, 8) for level in (2, 3))  # type: ignore[arg-type]
    assert len(fine.values) == len(fine.errors) == 8
    orders = np.log(coarse.errors / fine.errors) / np.log(coarse.edge_length / fine.edge_length)
    assert orders == pytest.approx(np.full(8, 2.0), abs=0.25)
    assert fine.errors[-1] > 2.0 * fine.errors[0]


def test_exact_values_are_those_of_the_shapes() -> None:
    assert eigenfunction_errors("sphere", 2, 8).values.tolist() == [2.0] * 3 + [6.0] * 5
    assert eigenfunction_errors("sphere", 2, 5).values.tolist() == [2.0] * 3 + [6.0] * 2  # part of an eigenspace
    first = np.pi**2 * np.array([1.0 / 1.5**2, 1.0, 1.0 + 1.0 / 1.5**2])
    assert eigenfunction_errors("rectangle", 2, 3).values == pytest.approx(first)


def test_midpoints_gain_four_on_the_smooth_surface_and_less_on_facets() -> None:
    on_facets, on_sphere, flat = (
        midpoint_gain(shape, 2, 8, project)  # type: ignore[arg-type]
        for shape, project in (("sphere", False), ("sphere", True), ("rectangle", False))
    )
    assert on_sphere == pytest.approx(np.full(8, 4.0), abs=0.5) and flat.min() > 3.0
    assert on_facets.min() < 1.5


def test_values_lie_above_on_facets_inside_and_below_on_facets_outside() -> None:
    assert values_below(3, 8, circumscribed=False) == 0
    assert values_below(3, 8, circumscribed=True) >= 3


def test_a_shape_without_exact_functions_is_refused() -> None:
    with pytest.raises(ValueError, match="'cup' has no exact eigenfunctions here, choose rectangle or sphere"):
        shape_mesh("cup", 2)  # type: ignore[arg-type]


def test_eigenspaces_of_the_rectangle_are_those_of_whole_numbers() -> None:
    """Of sides 3/2 and 1 the eigenvalues are pi^2 / 9 times 4 m^2 + 9 n^2."""
    numbers = Counter(4 * m**2 + 9 * n**2 for m in range(60) for n in range(60))
    expected = sorted(numbers)
    for (first, stop, value, _), number in zip(_groups("rectangle", 400), expected, strict=False):
        assert stop - first == numbers[number] and value == pytest.approx(np.pi**2 * number / 9.0, rel=1e-12)
