"""Two regions: what is proved, what masks do, how labels leave."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import nibabel
import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.shapes.cube import cube
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import surface_part
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.tasks.segmentation import Segmentation
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese, labelling_gap

SPHERE = sx.shape("icosphere", levels=3)
Z = SPHERE.mesh.vertices[:, 2]
NOISY = np.sign(Z) + 0.3 * np.random.default_rng(0).standard_normal(len(Z))
INSIDE = SPHERE.mesh.vertices[:, 0] > -0.5


@pytest.fixture(scope="module")
def parts():
    return sx.segment(SPHERE, NOISY, smoothness=0.3)


def test_regions_are_those_that_were_planted_and_means_are_theirs(parts) -> None:
    assert (parts.labels == (Z > 0)).mean() > 0.97
    mass = fem(SPHERE.mesh).mass
    for label, mean in ((1, parts.c1), (0, parts.c2)):
        weights = mass * (parts.labels == label)
        assert float(weights @ NOISY / weights.sum()) == pytest.approx(mean, rel=1e-3)
    assert parts.perimeter == pytest.approx(2 * np.pi, rel=0.2)


def test_bound_and_gap_belong_together(parts) -> None:
    assert parts.converged and 0 <= parts.gap <= 1e-3 and 0 <= parts.labelling_gap < 1
    assert parts.lower_bound <= parts.energy
    operator, image = fem(SPHERE.mesh), Image(NOISY)
    slope = ConvexChanVese().weight(image, operator) * ((parts.c1 - NOISY) ** 2 - (parts.c2 - NOISY) ** 2)

    def energy(labels: np.ndarray) -> float:
        phi = labels.astype(float)
        return total_variation(operator, phi) + float(operator.mass @ (slope * phi))

    assert energy(parts.labels) == pytest.approx(parts.energy)
    for other in (Z > 0, NOISY > 0, np.zeros(len(Z)), Z > 0.2):
        assert energy(other) > parts.lower_bound


def test_brightness_and_units_do_not_enter(parts) -> None:
    large = Surface(SPHERE.mesh.__class__(7.0 * SPHERE.mesh.vertices, SPHERE.mesh.faces))
    scaled = sx.segment(large, 40.0 * NOISY - 9, smoothness=0.3)
    assert (scaled.labels == parts.labels).mean() > 0.995
    assert scaled.gap == pytest.approx(parts.gap, abs=5e-3)
    turned = sx.segment(SPHERE, -NOISY, smoothness=0.3)
    assert (turned.labels == 1 - parts.labels).mean() > 0.995


def test_masking_equals_cutting_and_outside_changes_nothing() -> None:
    part = surface_part(SPHERE.mesh, INSIDE)
    masked = sx.segment(Surface(SPHERE.mesh, mask=INSIDE), np.where(INSIDE, NOISY, 1e6))
    cut = sx.segment(part.mesh, NOISY[part.vertices])
    assert np.array_equal(masked.labels[part.vertices], cut.labels) and masked.lower_bound == cut.lower_bound
    outside = np.setdiff1d(np.arange(len(Z)), part.vertices)
    assert (masked.labels[outside] == -1).all() and np.isnan(masked.values[outside]).all()
    by_nan = sx.segment(SPHERE, np.where(INSIDE, NOISY, np.nan))
    assert np.array_equal(by_nan.labels, masked.labels)
    assert any("these are the mask" in note for note in by_nan.notes)


@pytest.mark.slow
def test_without_a_map_the_clipped_mean_curvature_is_taken() -> None:
    torus = sx.shape("torus")
    alone = sx.segment(torus)
    curvature = sx.mean_curvature(torus)
    assert np.array_equal(alone.labels, sx.segment(torus, curvature).labels)
    assert np.array_equal(alone.labels, sx.segment(torus, 30.0 * curvature).labels)
    assert np.array_equal(alone.labels, 1 - sx.segment(torus, -curvature).labels)
    assert any("clipped at" in note and "median of its size" in note for note in alone.notes)
    radius = np.hypot(*torus.mesh.vertices[:, :2].T)
    assert radius[alone.labels == 1].mean() > radius[alone.labels == 0].mean()


@pytest.mark.slow
def test_planted_phases_are_found_whatever_their_share() -> None:
    """Where the smoothness that has no eye for noise follows it."""
    ball = sx.shape("icosphere", levels=4)
    z, mass = ball.mesh.vertices[:, 2], fem(ball.mesh).mass
    rng = np.random.default_rng(3)
    normal, heavy = rng.standard_normal(len(z)), rng.laplace(size=len(z)) / np.sqrt(2.0)
    scores, before = [], []
    for share in (0.5, 0.1, 0.02):
        planted = z > np.quantile(z, 1.0 - share)
        for noise in (normal, heavy):
            rough = planted + 0.5 * noise
            for found, given in ((scores, {}), (before, {"smoothness": 0.3})):
                bright = sx.segment(ball, rough, **given).labels == 1
                found.append(2.0 * mass @ (bright & planted) / (mass @ bright + mass @ planted))
    assert np.mean(scores) > 0.85 > 0.75 > np.mean(before)
    assert min(np.array(scores) - before) > -0.01


@pytest.mark.slow
@pytest.mark.parametrize(("factor", "offset"), [(1e6, 3.0), (1e-9, 0.0), (-1.0, 0.0), (-4.0, 7.0)])
def test_scaling_and_negation_change_no_label_of_the_default(factor: float, offset: float) -> None:
    one, other = sx.segment(SPHERE, NOISY).labels, sx.segment(SPHERE, factor * NOISY + offset).labels
    assert np.array_equal(other, one if factor > 0 else 1 - one)


@pytest.mark.parametrize("name", ["parts.label.gii", "parts.annot"])
def test_labels_leave_and_come_back_as_a_mask(name: str, working_folder: Path) -> None:
    masked = sx.segment(Surface(SPHERE.mesh, mask=INSIDE), NOISY)
    sx.write(name, masked, SPHERE)
    sx.write("ball.ply", SPHERE)
    table = sx.read("ball.ply", labels={"parts": name}).labels["parts"]
    assert table.names == {0: "unknown", 1: "darker", 2: "brighter"}
    assert np.array_equal(table.where("brighter"), masked.labels == 1)
    assert np.array_equal(sx.read("ball.ply", mask=name).mask, masked.labels >= 0)
    assert np.array_equal(sx.read("ball.ply", mask=f"{name}:darker").mask, masked.labels == 0)
    if name.endswith(".gii"):
        assert np.array_equal(nibabel.load(name).agg_data(), masked.labels + 1)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        ({"values": np.zeros(len(Z))}, "constant"),
        ({"values": NOISY, "smoothness": -1}, "smoothness"),
        ({"values": NOISY, "tolerance": 0}, "tolerance = 0"),
        ({"values": np.stack([NOISY, NOISY], axis=1)}, "2 channels, one is needed"),
        ({"values": "nosuch"}, "nosuch"),
    ],
)
def test_what_cannot_be_divided_is_refused(call: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        sx.segment(SPHERE, **call)


def test_the_map_of_labels_is_unknown_outside_the_mask_alone() -> None:
    parts = Segmentation(np.array([0, 1, -1, 1, 0]), 1.0, 0.0, 1.0, 0.9, 0.1, 0.1, True, 2.0)
    assert np.array_equal(parts.values, [0.0, 1.0, np.nan, 1.0, 0.0], equal_nan=True)
    assert parts.label_map.keys.tolist() == [1, 2, 0, 2, 1]


@pytest.mark.parametrize("scale", [1e-165, 1e-6, 1e6, 1e150])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_units_over_hundreds_of_decades_change_no_label_and_no_proof(parts, scale: float, offset: float) -> None:
    other = sx.segment(SPHERE, scale * (NOISY + offset), smoothness=0.3)
    assert np.array_equal(other.labels, parts.labels)
    assert (other.energy, other.gap) == pytest.approx((parts.energy, parts.gap), rel=1e-6)
    assert other.c1 == pytest.approx(scale * (parts.c1 + offset), rel=1e-9)


def test_a_labelling_that_meets_its_bound_is_proved_optimal() -> None:
    """Also where a threshold is as good, so that nothing was left to gain: gap and labelling gap have one scale."""
    assert labelling_gap(-3.0, -3.0, 1.0) == 0.0
    assert labelling_gap(-3.0, -3.0 - 1e-13, 1e-13) == 0.0
    assert labelling_gap(-2.0, -3.0, 2.0) == 0.5
    clean = sx.segment(SPHERE, np.where(Z > 0.1, 1.0, 0.0), smoothness=0.01)
    assert clean.labelling_gap < 1.0
    ball = sx.shape("icosphere", levels=4)
    found = sx.segment(ball, np.where(ball.mesh.vertices[:, 2] > 0.0, 1.0, 0.0))
    assert found.energy - found.lower_bound < 1e-9 * abs(found.energy) and found.labelling_gap <= 1e-4


def test_a_constant_map_has_no_regions() -> None:
    with pytest.raises(ValueError, match="constant at 3, two regions need two values"):
        sx.segment(SPHERE, np.full(len(Z), 3.0))


def test_the_summary_counts_the_vertices_of_each_region() -> None:
    ball = sx.shape("icosphere", levels=3)
    values = np.where(ball.mesh.vertices[:, 2] > 0.4, 1.0, 0.0)
    values[:5] = np.nan
    found = sx.segment(ball, values)
    text = repr(found)
    for name, label in (("darker", 0), ("brighter", 1)):
        count = int((found.labels == label).sum())
        assert 0 < count < 642 and f"vertices {name} {count}" in text


@pytest.mark.parametrize("outside", ["loose", "flat"])
def test_a_part_is_segmented_by_its_curvature_whatever_lies_outside_the_mask(outside: str) -> None:
    body = sx.shape("ellipsoid", levels=3)
    count = len(body.vertices)
    vertices, faces = np.r_[body.vertices, np.full((3, 3), 9.0)], body.faces
    if outside == "flat":
        vertices[count + 1 :, 0] += [1.0, 2.0]
        faces = np.r_[faces, [[count, count + 1, count + 2]]]
    surface = sx.Surface((vertices, faces), mask=np.arange(count + 3) < count)
    found, alone = sx.segment(surface), sx.segment(body)
    assert np.array_equal(found.labels[:count], alone.labels) and (found.labels[count:] == -1).all()


def test_two_clean_levels_are_the_regions() -> None:
    upper = Z > 0.2
    noise = 1e-3 * np.random.default_rng(0).standard_normal(len(Z))
    np.testing.assert_array_equal(sx.segment(SPHERE, upper + noise).labels, upper)


@pytest.mark.parametrize("rotation", [(0.0, 0.0, 0.0), (10.0, 20.0, 30.0)])
def test_the_curvature_of_a_box_is_that_of_its_edges(rotation: tuple[float, float, float]) -> None:
    """On flat faces it is rounding, of which no region is made; nobody gave a map that could be refused."""
    box = cube(8, rotation=rotation)
    parts = sx.segment(box)
    straight = cube(8).mesh.vertices
    edges = (np.abs(straight) > 1.0 - 1e-9).sum(axis=1) > 1
    np.testing.assert_array_equal(parts.labels, edges)
    assert any("where it is not 0" in note for note in parts.notes)


@pytest.mark.parametrize("tried", [1, 3, 8])
def test_the_note_states_the_weight_that_was_solved(tried: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A region is empty for all weights but the last one tried; of 8 for all."""
    mus = []

    class Emptied(ConvexChanVese):
        def run(self, *given, **more):
            mus.append(self.mu)
            solution = super().run(*given, **more)
            empty = len(mus) < tried or tried == 8
            return replace(solution, metrics=solution.metrics | {"brighter_share": 0.0}) if empty else solution

    monkeypatch.setattr("surfexp.tasks.segmentation.ConvexChanVese", Emptied)
    notes = [note for note in sx.segment(SPHERE, NOISY).notes if "of what the noise asks for" in note]
    assert len(mus) == tried and len(notes) == (tried > 1)
    assert all(f"weighs {mus[0] / mus[-1]:g} of" in note for note in notes)
    assert all(("is empty" in note) == (tried == 8) for note in notes)


def test_where_curvature_is_not_known_nothing_is_divided() -> None:
    torus = sx.shape("torus")
    strip = np.array([[9.0, 0.0, 0.0], [10.0, 0.0, 0.0], [9.0, 1.0, 0.0], [10.0, 1.0, 0.5]])
    vertices = np.concatenate([torus.vertices, strip])
    faces = np.concatenate([torus.faces, np.array([[0, 1, 2], [1, 3, 2]]) + len(torus.vertices)])
    parts = sx.segment((vertices, faces))
    assert (parts.labels[-4:] == -1).all()
    assert np.isin(parts.labels[:-4], (0, 1)).all()
    assert any("finite at" in note for note in parts.notes)
