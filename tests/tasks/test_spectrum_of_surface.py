"""A spectrum asked more than once: every answer is that of the eigensolver, complete by inertia."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import surface_part

BODY = sx.shape("ellipsoid", levels=4)
ALL = sx.eigenpairs(BODY, 120)
SPECTRUM = sx.Spectrum(BODY)


@pytest.mark.parametrize("range_", [(5, 12), (30, 80), (0, 10), (60, 61), (1, 110)])
def test_a_window_holds_exactly_the_pairs_inside(range_: tuple[int, int]) -> None:
    first, last = range_
    low = 0.5 * (ALL.values[first] + ALL.values[first - 1]) if first else -1.0
    high = 0.5 * (ALL.values[last] + ALL.values[last - 1])
    found = SPECTRUM.between(low, high)
    assert found.complete and found.values == pytest.approx(ALL.values[first:last], rel=1e-8, abs=1e-8)
    assert found.residuals.max() <= 1e-8 and found.vectors.shape == (len(BODY.mesh.vertices), last - first)
    (top, number) = found.inertia[-1]
    assert top >= high and number == (ALL.values < top).sum()


def test_an_empty_window_is_an_answer() -> None:
    gap = int(np.argmax(np.diff(ALL.values[:20])))
    a, b = ALL.values[gap : gap + 2]
    found = SPECTRUM.between(a + 0.4 * (b - a), a + 0.6 * (b - a))
    assert found.complete and not len(found.values) and found.vectors.shape[1] == 0


def test_bounds_on_an_eigenvalue_of_high_multiplicity_take_all_of_it() -> None:
    sphere = sx.shape("icosphere", levels=4)
    values = sx.eigenpairs(sphere, 30).values
    found = sx.Spectrum(sphere).between(values[4] - 1e-9, values[24] + 1e-9)
    assert found.values == pytest.approx(values[4:25], rel=1e-8)


@pytest.mark.parametrize(("first", "last"), [(0, 0), (0, 3), (1, 3), (4, 8), (9, 15), (0, 8)])
def test_a_bound_that_is_an_eigenvalue_takes_all_that_equal_it(first: int, last: int) -> None:
    sphere = sx.shape("icosphere", levels=4)
    values = sx.eigenpairs(sphere, 30).values
    low, high = (0.0 if first == 0 else values[first]), values[last] if last else 1e-9
    found = sx.Spectrum(sphere).between(low, high)
    tied = (values >= low - 1e-8 * max(low, 1.0)) & (values <= high + 1e-8 * max(high, 1.0))
    assert found.complete and found.values == pytest.approx(values[tied], rel=1e-8, abs=1e-8)
    assert any("meet a bound" in note for note in found.notes)


def test_fewer_pairs_than_before_cost_nothing_and_are_the_lowest() -> None:
    spectrum = sx.Spectrum(BODY)
    many = spectrum.first(40)
    few = spectrum.first(7)
    assert few.vectors.base is not None and few.values == pytest.approx(ALL.values[:7], rel=1e-8, abs=1e-8)
    assert np.array_equal(few.vectors, many.vectors[:, :7]) and few.complete
    assert spectrum.count_below(0.5 * (ALL.values[9] + ALL.values[10])) == 10


def test_masking_equals_cutting() -> None:
    inside = BODY.mesh.vertices[:, 2] > -0.3
    part = surface_part(BODY.mesh, inside)
    masked = sx.Spectrum(Surface(BODY.mesh, mask=inside)).between(3.0, 20.0)
    cut = sx.Spectrum(part.mesh).between(3.0, 20.0)
    assert np.array_equal(masked.vectors, part.extend(cut.vectors), equal_nan=True)
    assert len(cut.values) > 3 and masked.values.tolist() == cut.values.tolist()


@pytest.mark.parametrize(("bounds", "words"), [((3.0, 2.0), "3 and 2"), ((0.0, 1e6), "quarter"), ((0, np.inf), "inf")])
def test_bounds_that_cannot_be_are_refused(bounds: tuple[float, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        SPECTRUM.between(*bounds)


def test_fewer_pairs_have_the_facts_of_their_own_and_name_a_cluster_that_they_cut() -> None:
    sphere = sx.shape("icosphere", levels=3)
    spectrum = sx.Spectrum(sphere)
    many, few, alone = spectrum.first(16), spectrum.first(6), sx.eigenpairs(sphere, 6)
    assert few.metrics["last_value"] == few.values[-1] != many.metrics["last_value"]
    assert few.metrics["largest_residual"] == few.residuals.max()
    assert few.metrics["clusters"] == len(few.clusters) == len(alone.clusters)
    assert few.notes == alone.notes and "k = 6 cuts a cluster" in few.notes[0]
    assert spectrum.first(4).notes == ()
