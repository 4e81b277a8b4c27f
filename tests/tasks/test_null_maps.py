"""Null maps of the face: what is kept, where nothing is known, what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.nulls.fields import gaussian_fields
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.fem import fem

BALL = sx.shape("icosphere", levels=3)
X, Y, Z = BALL.mesh.vertices.T
MASS = fem(BALL.mesh).mass


def test_modes_that_hold_the_map_keep_its_power() -> None:
    nulls = sx.null_maps(BALL, X * Y + Z, 50, modes=36)
    assert nulls.certificate["complete"] and nulls.certificate["share_in_modes"] > 0.999
    assert nulls.certificate["power_error"] < 1e-2
    squares = MASS @ nulls.values**2 / MASS.sum()
    assert squares == pytest.approx(MASS @ (X * Y + Z) ** 2 / MASS.sum(), rel=0.02)
    # the mean null of a map without mean is 0, within four standard errors
    assert np.abs(nulls.values.mean(axis=1)).max() < 4.0 * np.sqrt(squares.mean() * 3.0 / 50)
    again = sx.null_maps(BALL, X * Y + Z, 50, modes=36)
    assert (again.values == nulls.values).all()
    assert (sx.null_maps(BALL, X * Y + Z, 50, modes=36, seed=1).values != nulls.values).any()


def test_what_modes_leave_out_comes_back() -> None:
    rough = Z + 0.5 * np.random.default_rng(0).standard_normal(len(Z))
    nulls = sx.null_maps(BALL, rough, 50, modes=9)
    # in the consistent mass independent noise has half of its variance
    share = (1 / 3) / (1 / 3 + 0.5 * 0.25)
    assert nulls.certificate["share_in_modes"] == pytest.approx(share, abs=0.03)
    variance = MASS @ (nulls.values - MASS @ nulls.values / MASS.sum()) ** 2 / MASS.sum()
    centred = rough - MASS @ rough / MASS.sum()
    assert variance.mean() == pytest.approx(MASS @ centred**2 / MASS.sum(), rel=0.05)


def test_variograms_are_matched() -> None:
    smooth, rough = (sx.null_maps(BALL, values, 20, method="variogram") for values in (Z, np.sin(40.0 * X)))
    for nulls in (smooth, rough):
        assert nulls.values.shape == (642, 20) and nulls.certificate["variogram_error"] < 0.7
    ends = BALL.mesh.edges

    def steps(values: np.ndarray) -> float:
        """Mean square difference along edges over the variance."""
        return float(((values[ends[:, 0]] - values[ends[:, 1]]) ** 2).mean() / values.var())

    assert steps(smooth.values) < 0.2 * steps(rough.values)


@pytest.mark.parametrize(("width", "told"), [(0.02, False), (0.4, True), (2.0, False)])
def test_a_rest_that_is_smooth_is_told(width: float, told: bool) -> None:
    """Of white noise permuting loses nothing; of a field that few modes hold it loses the correlation of neighbours."""
    values = gaussian_fields(fem(BALL.mesh), width, 1, seed=1)[:, 0]
    nulls = sx.null_maps(BALL, values, 200, modes=16)
    ends = BALL.mesh.edges

    def covariance(maps: np.ndarray) -> np.ndarray:
        centred = maps - maps.mean(axis=0)
        return np.asarray((centred[ends[:, 0]] * centred[ends[:, 1]]).mean(axis=0) / maps.var(axis=0))

    lost = float(covariance(values[:, None])[0] - covariance(nulls.values).mean())
    assert nulls.certificate["rest_correlation"] == pytest.approx(lost, abs=0.04)
    assert any("too rough" in note for note in nulls.notes) == told == (lost > 0.05)


def test_the_mask_is_kept() -> None:
    holed = np.where(Z > -0.5, X, np.nan)
    nulls = sx.null_maps(BALL, holed, 5, modes=16)
    assert (np.isfinite(nulls.values).all(axis=1) == np.isfinite(holed)).sum() >= len(Z) - 60
    assert not np.isfinite(nulls.values[np.isnan(holed)]).any()
    assert any("these are the mask" in note for note in nulls.notes)
    assert "null maps by eigenstrapping" in repr(nulls)


def test_what_cannot_be_turned_is_refused() -> None:
    with pytest.raises(ValueError, match="is constant"):
        sx.null_maps(BALL, np.ones(len(Z)), 5)
    with pytest.raises(ValueError, match="has 3 channels"):
        sx.null_maps(BALL, BALL.mesh.vertices, 5)
    with pytest.raises(ValueError, match="choose one of eigenstrapping, variogram"):
        sx.null_maps(BALL, Z, 5, method="spin")  # type: ignore[arg-type]


TWO = TriangleMesh(
    np.concatenate([BALL.mesh.vertices, BALL.mesh.vertices + 3.0]),
    np.concatenate([BALL.mesh.faces, BALL.mesh.faces + len(Z)]),
)


@pytest.mark.parametrize("method", ["eigenstrapping", "variogram"])
def test_two_hemispheres_are_taken_at_once(method: str) -> None:
    """Modes of each hemisphere keep its own mean and power, and their nulls are independent."""
    values = np.concatenate([X * Y + Z, 2.0 * Z * Z + 5.0])
    nulls = sx.null_maps(TWO, values, 40, method=method, modes=36)  # type: ignore[arg-type]
    assert np.isfinite(nulls.values).all() and not nulls.notes
    if method == "variogram":
        return
    assert nulls.certificate["share_in_modes"] > 0.999 and nulls.certificate["complete"]
    left, right = nulls.values[: len(Z)], nulls.values[len(Z) :]
    for half, wanted in ((left, values[: len(Z)]), (right, values[len(Z) :])):
        mean = MASS @ wanted / MASS.sum()
        assert MASS @ half / MASS.sum() == pytest.approx(np.full(40, mean), abs=1e-5)
        assert MASS @ (half - mean) ** 2 == pytest.approx(np.full(40, MASS @ (wanted - mean) ** 2), rel=0.05)
    alone = sx.null_maps(BALL, values[: len(Z)], 40, modes=36).values
    assert left == pytest.approx(alone, abs=1e-6)
    same = [np.corrcoef(left[:, k], right[:, k])[0, 1] for k in range(40)]
    assert np.mean(np.abs(same)) < 0.6


def test_variograms_of_two_hemispheres_are_drawn_apart() -> None:
    """Values went across and only the mean of both was kept: two maps that share nothing but an offset of the sides had p = .01."""
    values = np.concatenate([X * Y + Z, 2.0 * Z * Z + 5.0])
    nulls = sx.null_maps(TWO, values, 40, method="variogram").values
    alone = sx.null_maps(BALL, values[: len(Z)], 40, method="variogram").values
    # numbers of another scale, by own_unit
    np.testing.assert_allclose(nulls[: len(Z)], alone, rtol=1e-9, atol=1e-9)
    right = nulls[len(Z) :]
    np.testing.assert_allclose(right.mean(axis=0), values[len(Z) :].mean(), rtol=1e-12)
    assert np.mean([abs(np.corrcoef(alone[:, k], right[:, k])[0, 1]) for k in range(40)]) < 0.6
    small = sx.shape("icosphere", levels=2).mesh
    unequal = TriangleMesh(
        np.concatenate([BALL.mesh.vertices, small.vertices + 3.0]), np.concatenate([BALL.mesh.faces, small.faces + 642])
    )
    with pytest.raises(ValueError, match="162 vertices of a component are too few for variograms, take method="):
        sx.null_maps(unequal, unequal.vertices[:, 2], 5, method="variogram")
    offset = np.repeat([0.0, 9.0], len(Z))
    found = sx.compare_maps(TWO, np.tile(X, 2) + offset, np.tile(Y, 2) + offset, method="variogram", count=99)
    assert found.r > 0.9 and found.p > 0.2


@pytest.mark.parametrize("method", ["eigenstrapping", "variogram"])
def test_islands_are_named_and_left_out(method: str) -> None:
    vertices = np.concatenate([BALL.mesh.vertices, [[5.0, 0, 0], [6.0, 0, 0], [5.0, 1.0, 0]]])
    with_island = TriangleMesh(vertices, np.concatenate([BALL.mesh.faces, [[642, 643, 644]]]))
    nulls = sx.null_maps(with_island, np.append(Z, [1.0, 2.0, 3.0]), 9, method=method, modes=25)  # type: ignore[arg-type]
    assert np.isnan(nulls.values[642:]).all() and np.isfinite(nulls.values[:642]).all()
    assert "1 islands of few vertices (3 at vertex 642)" in nulls.notes[-1]
    assert np.array_equal(nulls.values[:642], sx.null_maps(BALL, Z, 9, method=method, modes=25).values)  # type: ignore[arg-type]


def test_the_share_in_modes_is_one_of_variance_by_area() -> None:
    """On a ball with one large half, whose modes have another mean over vertices than by area, which is 0.

    The map is the sum of a mode and of what no low mode holds.
    """
    larger = np.where(BALL.mesh.vertices[:, 2] > 0.0, 4.0, 1.0)
    stretched = TriangleMesh(BALL.mesh.vertices * larger[:, None], BALL.mesh.faces)
    system = sx.eigenpairs(stretched, 30)
    mass = mass_matrix(fem(stretched))
    values = system.vectors[:, 1] + 2.0 * system.vectors[:, 29]
    for shift in (0.0, 7.0):
        share = sx.null_maps(stretched, values + shift, 3, modes=9).certificate["share_in_modes"]
        assert share == pytest.approx(0.2, abs=1e-6)
    assert system.vectors[:, 1] @ (mass @ system.vectors[:, 1]) == pytest.approx(1.0)


def test_a_component_on_which_the_map_is_constant_stays_so() -> None:
    """It was divided by its power, which is 0."""
    ball = sx.shape("icosphere", levels=2).mesh
    both = np.r_[ball.vertices, ball.vertices + 5.0], np.r_[ball.faces, ball.faces + 162]
    height = ball.vertices[:, 2]
    found = sx.null_maps(both, np.r_[height, np.full(162, 0.7)], 5, modes=9)
    alone = sx.null_maps((ball.vertices, ball.faces), height, 5, modes=9)
    assert np.ptp(found.values[162:], axis=0).max() == 0.0 and found.values[162:] == pytest.approx(0.7)
    assert found.values[:162].std(axis=0) == pytest.approx(alone.values.std(axis=0), rel=1e-6)
    assert found.certificate["share_in_modes"] == pytest.approx(alone.certificate["share_in_modes"])
    assert "The map is constant on a component of 162 vertices, and so are its null maps there." in found.notes
    for method in ("eigenstrapping", "variogram"):
        with pytest.raises(ValueError, match="constant on each component"):
            sx.null_maps(both, np.repeat([0.0, 1.0], 162), 5, modes=9, method=method)  # type: ignore[arg-type]
    found = sx.null_maps(TWO, np.r_[Z, np.full(642, 0.7)], 5, method="variogram")
    assert found.values[642:] == pytest.approx(0.7) and "642 vertices, and so are" in found.notes[0]


def test_a_small_surface_has_fewer_modes_than_the_default_asks_for() -> None:
    """It was refused: "k = 400 eigenpairs of 162 degrees of freedom"."""
    ball = sx.shape("icosphere", levels=2)
    height = ball.mesh.vertices[:, 2]
    found = sx.null_maps(ball, height, 5)
    assert found.certificate["modes"] == 81 and found.certificate["complete"]
    assert found.notes[0].startswith("81 modes were turned, and not 400")
    assert "81 modes hold" in sx.compare_maps(ball, height, ball.mesh.vertices[:, 0], count=5).reason
    assert not sx.null_maps(ball, height, 5, modes=81).notes
    with pytest.raises(ValueError, match="modes = 1, at least 2 is needed"):
        sx.null_maps(ball, height, 5, modes=1)
    with pytest.raises(ValueError, match="the map is on 3 vertices, at least 4 are needed"):
        sx.null_maps((np.eye(3), [[0, 1, 2]]), [0.0, 1.0, 2.0], 5)


def test_threads_change_no_byte_and_modes_are_reported() -> None:
    fine = sx.shape("ellipsoid", levels=4)
    values = fine.mesh.vertices[:, 2] + fine.mesh.vertices[:, 0] ** 2
    seen: list[tuple[int, float]] = []
    one = sx.null_maps(fine, values, 5, modes=250, threads=1, progress=lambda *step: seen.append(step))
    assert seen and all(0.0 <= rest <= 1.0 for _, rest in seen) and seen[-1][0] >= 200
    assert np.array_equal(one.values, sx.null_maps(fine, values, 5, modes=250, threads=2).values)
    with pytest.raises(ValueError, match="threads"):
        sx.compare_maps(fine, values, fine.mesh.vertices[:, 1], count=5, modes=50, threads=0)
