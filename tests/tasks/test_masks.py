"""Every task on a masked surface equals the task on the cut mesh, and nothing outside the mask changes anything inside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

import surfexp as sx
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import surface_part
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.spectrum.surface_spectrum import elements_of

WHOLE = sx.shape("icosphere", levels=3)
INSIDE = WHOLE.mesh.vertices[:, 2] + 0.2 * WHOLE.mesh.vertices[:, 0] > -0.4
PART = surface_part(WHOLE.mesh, INSIDE)
CUT = Surface(PART.mesh)
MASKED = Surface(WHOLE.mesh, mask=INSIDE)
NOISY = WHOLE.mesh.vertices[:, 2] + 0.2 * np.random.default_rng(0).standard_normal(len(INSIDE))


def on_whole(values: np.ndarray) -> np.ndarray:
    return PART.extend(values)


@pytest.mark.parametrize(
    "task",
    [
        lambda s, f: sx.denoise(s, f).values,
        lambda s, f: sx.denoise(s, f, method="tgv").values,
        lambda s, f: sx.denoise(s, f, method="auto").values,
        lambda s, f: sx.smooth(s, f, 0.3).values,
        lambda s, f: sx.eigenpairs(s, 12).vectors,
    ],
    ids=["denoise", "tgv", "auto", "smooth", "eigenpairs"],
)
def test_masking_equals_cutting(task) -> None:
    masked, cut = task(MASKED, NOISY), task(CUT, NOISY[PART.vertices])
    assert np.array_equal(masked, on_whole(cut), equal_nan=True)


def test_labels_of_another_surface_are_refused(tmp_path: Path) -> None:
    ball = sx.shape("icosphere", levels=1)
    sx.write(tmp_path / "ball.ply", ball)
    sx.write(tmp_path / "parts.label.gii", np.arange(10) % 2)
    with pytest.raises(ValueError, match=f"labels 'parts' have 10 entries, .* has {len(ball.mesh.vertices)} vertices"):
        sx.read(tmp_path / "ball.ply", labels={"parts": tmp_path / "parts.label.gii"})


def test_nan_in_the_map_is_the_mask_and_is_said() -> None:
    holed = np.where(INSIDE, NOISY, np.nan)
    by_nan, by_mask = sx.denoise(WHOLE, holed), sx.denoise(MASKED, NOISY)
    assert np.array_equal(by_nan.values, by_mask.values, equal_nan=True)
    assert any("these are the mask" in note for note in by_nan.notes)
    assert not any("these are the mask" in note for note in by_mask.notes)


def test_nothing_outside_changes_a_value_inside() -> None:
    other = np.where(INSIDE, NOISY, 1e6)
    for task in (sx.denoise, lambda s, f: sx.smooth(s, f, 0.3)):
        assert np.array_equal(task(MASKED, NOISY).values, task(MASKED, other).values, equal_nan=True)


def test_constants_stay_constants_to_the_boundary() -> None:
    flat = np.where(INSIDE, 3.0, np.nan)
    smoothed = sx.smooth(WHOLE, flat, 0.5).values
    assert smoothed[PART.vertices] == pytest.approx(3.0, abs=1e-12)
    assert np.isnan(smoothed[~np.isin(np.arange(len(flat)), PART.vertices)]).all()
    for method in ("rof", "auto"):
        clean = sx.denoise(WHOLE, flat, method=method, noise=1.0)  # type: ignore[arg-type]
        assert clean.values[PART.vertices] == pytest.approx(3.0, abs=1e-9)


def test_distances_stay_inside_the_mask() -> None:
    source = int(np.argmax(WHOLE.mesh.vertices[:, 2]))
    inside = sx.geodesic(MASKED, source)
    number = int(np.flatnonzero(PART.vertices == source)[0])
    assert np.array_equal(inside, on_whole(sx.geodesic(CUT, number)), equal_nan=True)
    with pytest.raises(ValueError, match="outside the mask"):
        sx.geodesic(MASKED, int(np.argmin(WHOLE.mesh.vertices[:, 2])))


def test_spectral_distance_of_a_masked_surface_to_its_cut_copy_is_zero() -> None:
    stretched = Surface(TriangleMesh(WHOLE.mesh.vertices * [1.0, 1.3, 1.7], WHOLE.mesh.faces), mask=INSIDE)
    part = surface_part(stretched.mesh, INSIDE)
    found = sx.distance(stretched, Surface(part.mesh), n=6)
    assert found.optimal and found.value == pytest.approx(0.0, abs=1e-8)
    assert np.array_equal(found.correspondence, part.vertices)


def test_what_a_map_does_not_know_inside_the_mask_is_outside() -> None:
    ball = sx.shape("icosphere", levels=3)
    height = ball.vertices[:, 2]
    mask, known = height > -0.5, height < 0.8
    values = height + 0.1 * np.random.default_rng(0).standard_normal(len(height))
    masked, narrow = replace(ball, mask=mask), replace(ball, mask=mask & known)
    holes = np.where(known, values, np.nan)
    for task in (
        lambda s, v: sx.denoise(s, v),
        lambda s, v: sx.denoise(s, v, method="rof"),
        lambda s, v: sx.smooth(s, v, 0.5),
        lambda s, v: sx.segment(s, v),
    ):
        found, wanted = task(masked, holes), task(narrow, values)
        np.testing.assert_array_equal(getattr(found, "values", found), getattr(wanted, "values", wanted))
        said = (
            f"The map is NaN at {(mask & ~known).sum()} of the {mask.sum()} vertices inside the mask: they are outside."
        )
        assert said in found.notes
    with pytest.raises(ValueError, match=r"map is NaN at all \d+ vertices inside the mask: give another mask"):
        sx.denoise(masked, np.where(mask, np.nan, values))


def scattered(seed: int, share: float) -> np.ndarray:
    """Holes of single vertices, between which the faces left touch in a vertex alone."""
    return np.random.default_rng(seed).random(len(INSIDE)) >= share


@pytest.mark.parametrize(("seed", "share"), [(0, 0.05), (1, 0.1), (2, 0.2)])
def test_a_mask_may_leave_faces_that_touch_in_a_vertex(seed: int, share: float) -> None:
    inside = scattered(seed, share)
    masked = Surface(WHOLE.mesh, mask=inside)
    holed = np.where(inside, NOISY, np.nan)
    assert sx.check(surface_part(WHOLE.mesh, inside).mesh).count("non-manifold vertices") > 0
    for task in (lambda s, f: sx.smooth(s, f, 0.3), lambda s, f: sx.denoise(s, f, method="rof")):
        assert np.array_equal(task(masked, NOISY).values, task(WHOLE, holed).values, equal_nan=True)
    part = surface_part(WHOLE.mesh, inside)
    elements = elements_of(Surface(part.mesh), fem(part.mesh), 1)
    expected = scipy.linalg.eigh(elements.stiffness.toarray(), elements.mass.toarray(), eigvals_only=True)[:8]
    found = sx.eigenpairs(masked, 8)
    assert found.complete
    assert found.values == pytest.approx(expected, abs=1e-9 * expected[-1])
    assert np.isfinite(sx.mean_curvature(masked)[part.vertices]).all()


def test_faces_that_touch_in_a_vertex_of_the_surface_itself_are_refused_under_a_mask() -> None:
    mesh = WHOLE.mesh
    vertices = np.r_[mesh.vertices, mesh.vertices + 2.0 * mesh.vertices[0]]
    far = int(np.linalg.norm(mesh.vertices + mesh.vertices[0], axis=1).argmin())
    touching = mesh.faces + len(mesh.vertices)
    touching[touching == len(mesh.vertices) + far] = 0
    inside = np.r_[scattered(0, 0.05), scattered(1, 0.05)]
    inside[[0, *np.unique(mesh.faces[(mesh.faces == 0).any(axis=1)])]] = True
    inside[len(mesh.vertices) + np.unique(mesh.faces[(mesh.faces == far).any(axis=1)])] = True
    both = Surface(TriangleMesh(vertices, np.r_[mesh.faces, touching]), mask=inside)
    with pytest.raises(ValueError, match="non-manifold vertices"):
        sx.eigenpairs(both, 4)
    assert sx.eigenpairs(sx.repair(both), 4).complete
