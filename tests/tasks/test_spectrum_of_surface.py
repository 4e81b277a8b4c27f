"""A spectrum asked more than once: every answer is that of the eigensolver, complete by inertia."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh

import surfexp as sx
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import surface_part
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem

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


SMALL = sx.shape("icosphere", levels=2)
HALF = Surface(SMALL.mesh, mask=SMALL.mesh.vertices[:, 2] > -0.2)
ASKED = {"multiple": sx.Spectrum(SMALL), "masked": sx.Spectrum(HALF), "lumped": sx.Spectrum(SMALL, mass="lumped")}


@cache
def every_value(name: str) -> np.ndarray:
    """All eigenvalues by dense algebra, from matrices assembled anew."""
    asked = ASKED[name]
    operator = fem(asked.part.mesh)
    mass = np.diag(operator.mass) if name == "lumped" else mass_matrix(operator).toarray()
    return eigh(stiffness(operator).toarray(), mass, eigvals_only=True)


@settings(max_examples=60)
@given(
    st.sampled_from(list(ASKED)),
    *(st.integers(0, 18), st.integers(0, 12)),
    *(st.sampled_from([-0.3, -1e-12, 0.0, 1e-12, 0.4]), st.sampled_from([-0.3, -1e-12, 0.0, 1e-12, 0.4])),
)
def test_a_random_window_is_complete(name: str, first: int, more: int, below: float, above: float) -> None:
    """Ends that lie between eigenvalues or on one, simple or multiple: what is returned is what dense algebra has there."""
    values = every_value(name)
    low = float(values[first] + below * max(values[first], 1.0))
    high = float(values[first + more] + above * max(values[first + more], 1.0))
    if not low < high or 4 * int(((values >= low) & (values <= high * 1.02 + 0.02)).sum() + 8) > len(values):
        return
    found = ASKED[name].between(low, high)
    near = 1e-7 * max(abs(low), abs(high), 1.0)
    surely = values[(values > low + near) & (values < high - near)]
    perhaps = values[(values > low - near) & (values < high + near)]
    assert found.complete and len(surely) <= len(found.values) <= len(perhaps)
    assert (len(found.values) == len(perhaps)) or len(surely) < len(perhaps)
    # all that equal an end are in or out together
    inside = values[(values >= low - 1e-9 * max(abs(low), 1.0)) & (values <= high + 1e-9 * max(abs(high), 1.0))]
    assert found.values == pytest.approx(inside, rel=1e-7, abs=1e-8)


@settings(max_examples=30)
@given(st.sampled_from(list(ASKED)), st.integers(1, 38))
def test_the_first_pairs_and_the_counts_are_those_of_dense_algebra(name: str, count: int) -> None:
    values = every_value(name)
    found = ASKED[name].first(count)
    assert found.complete and found.values == pytest.approx(values[:count], rel=1e-7, abs=1e-8)
    gap = values[count] - values[count - 1]
    if gap > 0.01 * values[count]:
        assert ASKED[name].count_below(float(values[count - 1] + 0.5 * gap)) == count
    assert np.isnan(found.vectors[~np.isin(np.arange(len(SMALL.mesh.vertices)), ASKED[name].part.vertices)]).all()
