"""What denoise, noise and segment answer to maps that are hardly maps."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.contract.arrays import Floats

BALL = sx.shape("icosphere", levels=3)
X, Y, Z = BALL.mesh.vertices.T
RNG = np.random.default_rng(0)
SMOOTH = np.sin(3.0 * X) + 0.3 * RNG.standard_normal(len(X))
TWO = (Z > 0.1).astype(np.float64)
WHOLE = np.round(SMOOTH)
ZEROS = np.where(Z > 0.2, SMOOTH, 0.0)


@pytest.mark.parametrize("task", [sx.denoise, sx.noise, sx.segment])
def test_a_constant_is_refused_by_name(task) -> None:
    with pytest.raises(ValueError, match="map is constant at 2"):
        task(BALL, np.full(len(X), 2.0))


@pytest.mark.parametrize("task", [sx.denoise, sx.noise, sx.segment])
def test_one_code_for_no_data_is_refused_with_its_vertex(task) -> None:
    values = SMOOTH.copy()
    values[7] = -9999.0
    with pytest.raises(ValueError, match="at vertex 7"):
        task(BALL, values)


@pytest.mark.parametrize("values", [TWO, WHOLE, ZEROS], ids=["two values", "integers", "zeros on 60 %"])
def test_ties_are_denoised_with_a_note_and_within_their_range(values: Floats) -> None:
    found = sx.denoise(BALL, values)
    assert np.isfinite(found.values).all() and found.certificate["noise"] > 0.0
    assert found.certificate["noise_kind"] != "white" and found.notes
    assert values.min() - 1e-9 <= found.values.min() and found.values.max() <= values.max() + 1e-9


def test_two_values_are_divided_where_they_are() -> None:
    parts = sx.segment(BALL, TWO)
    assert (parts.labels == TWO).mean() > 0.97 and 0.0 < parts.labels.mean() < 1.0


def test_islands_of_nan_lie_outside_and_change_nothing_far_away() -> None:
    holed = np.where(np.isin(np.arange(len(X)), RNG.choice(len(X), 30, replace=False)), np.nan, SMOOTH)
    found = sx.denoise(BALL, holed)
    assert np.array_equal(np.isnan(found.values), np.isnan(holed))
    assert (sx.segment(BALL, holed).labels[np.isnan(holed)] == -1).all()


def test_a_map_without_noise_says_so() -> None:
    flat = sx.shape("rectangle")
    with pytest.raises(ValueError, match=r"noise is .*, it must be positive: give the noise"):
        sx.denoise(flat, flat.mesh.vertices[:, 0] + flat.mesh.vertices[:, 1])


def test_a_weight_belongs_to_a_method_that_reads_it() -> None:
    with pytest.raises(ValueError, match=r"weight = 0\.5 belongs to method rof or tgv"):
        sx.denoise(BALL, SMOOTH, weight=0.5)
    with pytest.raises(ValueError, match=r"ratio = 3\.0 belongs to method tgv, the method is rof"):
        sx.denoise(BALL, SMOOTH, method="rof", ratio=3.0)


def test_several_channels_are_denoised_together_and_it_is_said() -> None:
    both = np.column_stack([SMOOTH, Y + SMOOTH])
    found = sx.denoise(BALL, both)
    assert found.method == "rof" and any("2 channels" in note for note in found.notes)
    assert np.array_equal(found.values, sx.denoise(BALL, both, method="rof").values)
