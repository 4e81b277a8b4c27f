"""Numbers, whole numbers and masks in every dress in which they are handed in."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from surfexp.mesh.given_arrays import index_array, mask_array, real_array
from surfexp.mesh.given_numbers import real_number, whole_number
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

VALUES = np.array([1.0, 0.0, 2.0, 3.0])


@pytest.mark.parametrize(
    "given",
    [
        VALUES,
        VALUES.astype(np.float32),
        VALUES.astype(np.float16),
        VALUES.astype(">f8"),
        VALUES.astype(np.int8),
        VALUES.tolist(),
        tuple(VALUES),
        np.repeat(VALUES, 2)[::2],
        pd.Series(VALUES),
        pd.Series([1, 0, 2, 3], dtype="Int64"),
        np.ma.masked_array(VALUES, False),
    ],
    ids=lambda given: f"{type(given).__name__} {getattr(given, 'dtype', '')}",
)
def test_real_numbers_are_taken_as_they_are(given: Any) -> None:
    taken = real_array(given, "map")
    assert taken.dtype == np.float64 and np.array_equal(taken, VALUES)


def test_what_is_hidden_is_nan_and_outside() -> None:
    hidden = np.ma.masked_array(VALUES, [False, False, True, False])
    assert np.array_equal(real_array(hidden, "map"), [1, 0, np.nan, 3], equal_nan=True)
    assert mask_array(hidden, 4).tolist() == [True, False, False, True]
    missing = pd.Series([1, None, 2, 3], dtype="Int64")
    assert np.array_equal(real_array(missing, "map"), [1, np.nan, 2, 3], equal_nan=True)


def test_nan_in_a_mask_is_outside() -> None:
    assert mask_array([1.0, np.nan, 0.0, 5.0], 4).tolist() == [True, False, False, True]
    assert mask_array(np.ones((4, 1), dtype=bool), 4).all()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (VALUES + 1j, "complex128"),
        (["0", "1"], "<U1"),
        ([object()], "object"),
        ([[1.0], [1.0, 2.0]], "no array of numbers"),
        (np.array(["2020-01-01"], dtype="M8[D]"), "datetime64"),
        (np.zeros(2, dtype=[("x", float)]), "structured"),
        ([1.0, np.inf], "1 infinite values of 2"),
    ],
)
def test_what_is_no_real_number_is_refused_by_name(given: Any, words: str) -> None:
    with pytest.raises(ValueError, match="the map") as refused:
        real_array(given, "the map")
    assert words in str(refused.value)


@pytest.mark.parametrize("given", [[0.7, 1.0], [True, False], [np.nan, 1.0], [1e300], [2**63], ["1"]])
def test_what_is_no_whole_number_is_no_index(given: Any) -> None:
    with pytest.raises(ValueError, match="faces"):
        index_array(np.array(given), "faces")


@pytest.mark.parametrize("given", [5, 5.0, np.int8(5), np.float32(5), np.array(5)])
def test_whole_floats_are_whole_numbers(given: Any) -> None:
    assert whole_number(given, "k", 1) == 5


@pytest.mark.parametrize("given", ["5", 2.5, 1e300, True, None, np.nan, np.inf, [5], 0, -1])
def test_other_things_are_no_counts(given: Any) -> None:
    with pytest.raises(ValueError, match=r"^k = .*1 to 100 is needed$"):
        whole_number(given, "k", 1, 100)


@pytest.mark.parametrize("given", ["3mm", 0.0, -1.0, np.nan, np.inf, 1.0, None, True, [0.5], 1j])
def test_other_things_are_no_numbers_between_bounds(given: Any) -> None:
    with pytest.raises(ValueError, match=r"^width = .*above 0 and below 1 is needed$"):
        real_number(given, "width", above=0.0, below=1.0)


def test_nobody_else_can_change_a_surface() -> None:
    ball = icosphere(2).mesh
    vertices, faces = ball.vertices.copy(), ball.faces.copy()
    height, mask = vertices[:, 2].copy(), vertices[:, 2] > 0
    surface = Surface(TriangleMesh(vertices, faces), scalars={"height": height}, mask=mask)
    area = surface.mesh.area
    vertices *= 10
    faces[:] = 0
    height[:] = 0
    mask[:] = False
    assert surface.mesh.area == area and np.array_equal(surface.mesh.vertices, ball.vertices)
    assert np.array_equal(surface.mesh.faces, ball.faces)
    assert np.array_equal(surface.scalars["height"], ball.vertices[:, 2]) and surface.mask is not None
    assert surface.mask.sum() == (ball.vertices[:, 2] > 0).sum()
    with pytest.raises(ValueError, match="read-only"):
        surface.mesh.vertices[0] = 0.0


def test_a_read_only_view_of_a_writable_array_is_copied() -> None:
    vertices = icosphere(1).mesh.vertices.copy()
    view = vertices.view()
    view.flags.writeable = False
    mesh = TriangleMesh(view, icosphere(1).mesh.faces)
    vertices *= 10
    assert np.abs(mesh.vertices).max() < 2
    assert np.shares_memory(TriangleMesh(mesh.vertices, mesh.faces).vertices, mesh.vertices), "frozen arrays are shared"
