"""People are recognised where they are planted; certificates hold; descriptors are what they say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from surfexp.anatomy.label_volume import LabelVolume
from surfexp.anatomy.subcortical import surface_of_label
from surfexp.contract.member import Member
from surfexp.embedding.distance_methods import Pairing
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.populations.synthetic_subject import random_displacement
from surfexp.spectrum.heat_trace import heat_trace
from surfexp.spectrum.shape_distributions import RELATIVE_TIMES
from surfexp.spectrum.signature import Signature
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp.statistics.resampling import exact_interval
from surfexp_studies.fingerprints import people
from surfexp_studies.fingerprints.certificate import share_beyond, value_radii
from surfexp_studies.fingerprints.descriptors import (
    BRAINPRINT,
    DESCRIPTORS,
    descriptors,
    fingerprint,
    heat_means,
    wave_means,
)
from surfexp_studies.fingerprints.grouped_intervals import grouped_intervals
from surfexp_studies.fingerprints.identification import identification
from surfexp_studies.fingerprints.pairwise_identification import pairwise_identification
from surfexp_studies.fingerprints.recognition import by_change, recognition
from surfexp_studies.fingerprints.reliability import constant_entries, median_reliability, reliability_within
from surfexp_studies.fingerprints.usual_spectrum import usual_spectrum

ROUGH = add_vertex_noise(icosphere(2), 0.02)
OPERATOR = fem(ROUGH.mesh)
STIFF, MASS = stiffness(OPERATOR), mass_matrix(OPERATOR)
EXACT = eigh(STIFF.toarray(), MASS.toarray())


@pytest.fixture(scope="module")
def seen() -> Signature:
    return fingerprint(ROUGH, 60)


@pytest.mark.parametrize("size", [0.0, 1e-6, 1e-3, 0.1])
def test_radii_hold_an_eigenvalue_and_bound_the_residual(size: float) -> None:
    noise = np.random.default_rng(1).normal(size=EXACT[1][:, :12].shape)
    vectors = EXACT[1][:, :12] + size * noise
    scale = (vectors * (MASS @ vectors)).sum(axis=0)
    values = (vectors * (STIFF @ vectors)).sum(axis=0) / scale
    system = surface_spectrum(ROUGH, OPERATOR, 12)
    radii = value_radii(OPERATOR, replace(system, values=values, vectors=3.0 * vectors))
    distance = np.abs(values[:, None] - EXACT[0]).min(axis=1)
    assert (distance <= radii + 1e-11).all()
    residual = STIFF @ vectors - (MASS @ vectors) * values
    sharp = np.sqrt((residual * np.linalg.solve(MASS.toarray(), residual)).sum(axis=0) / scale)
    # a quarter of the lumped mass is below the mass, the lumped mass is above it
    assert (sharp <= radii + 1e-12).all() and (radii <= 2.0 * sharp + 1e-12).all()


def test_radii_of_another_mesh_are_refused() -> None:
    with pytest.raises(ValueError, match="vectors have 42 rows, the operator has 162 vertices"):
        value_radii(OPERATOR, surface_spectrum(icosphere(1), fem(icosphere(1).mesh), 5))


def test_only_what_both_certificates_do_not_cover_is_beyond() -> None:
    first, second = np.zeros((3, 2)), np.array([[0.1, 0.0], [0.0, -0.31], [0.3, 0.2]])
    radii = np.full((3, 2), 0.1)
    np.testing.assert_array_equal(share_beyond(first, second, radii, 2 * radii), [0, 1, 0])


def test_the_usual_solver_finds_the_spectrum_of_dense_algebra() -> None:
    found = usual_spectrum(OPERATOR, 40)
    np.testing.assert_allclose(found.values, EXACT[0][:40], atol=1e-9)
    assert not found.complete and found.area == pytest.approx(ROUGH.mesh.area)
    assert found.orthogonality < 1e-9 and found.residuals.max() < 1e-9
    with pytest.raises(ValueError, match="count = 161 pairs of 162 vertices: take 1 to 160"):
        usual_spectrum(OPERATOR, 161)


def test_descriptors_are_what_they_say(seen: Signature) -> None:
    assert {"shape_dna", *seen.parts} >= {*DESCRIPTORS} | {f"usual {name}" for name in DESCRIPTORS}
    scaled = ROUGH.mesh.area * EXACT[0]
    np.testing.assert_allclose(seen.values, scaled[1:36], rtol=1e-7)
    np.testing.assert_allclose(seen.part("brainprint"), scaled[1:51] / np.arange(1, 51), rtol=1e-7)
    assert len(seen.part("nodal_counts")) == 60 and seen.part("nodal_counts")[0] == 2
    for name in ("shape_dna", "brainprint"):
        for route in ("", "usual "):
            radii = seen.part(f"radii {route}{name}")
            assert len(radii) == len(seen.part(name)) and (radii > 0).all() and (radii < 1e-4).all()
    assert seen.metrics["complete"] == 1 and seen.metrics["vertices"] == 162
    few = surface_spectrum(ROUGH, OPERATOR, BRAINPRINT)
    with pytest.raises(ValueError, match="has 50 values, descriptors need at least 51"):
        descriptors(few, None, ROUGH.mesh.vertex_areas)  # type: ignore[arg-type]


def test_means_by_area_forget_the_surface() -> None:
    """The mean of the wave kernel signature is 1 / A and that of the heat kernel Z / A, to the lumping of areas."""
    errors = []
    for levels in (2, 3):
        body = ellipsoid(levels, (1.0, 1.3, 1.7))
        system = surface_spectrum(body, fem(body.mesh), 16)
        areas = body.mesh.vertex_areas
        times = RELATIVE_TIMES[RELATIVE_TIMES > 0.02] * system.area / (4 * np.pi)
        trace = np.log(np.exp(-np.multiply.outer(system.values, times)).sum(axis=0))
        errors.append((np.abs(wave_means(system, areas) - 1).max(), np.abs(heat_means(system, areas) - trace).max()))
        assert np.abs(trace - np.log(heat_trace(system.values, times, system.area)))[-1] < 2e-3
        curved = surface_spectrum(body, fem(body.mesh), 16, order=2)
        assert len(curved.vectors) > len(areas)  # of nodes on edges nothing is asked
        assert heat_means(curved, areas) == pytest.approx(heat_means(system, areas), abs=0.1)
    (coarse_wave, coarse_heat), (fine_wave, fine_heat) = errors
    assert fine_wave < 0.05 and fine_heat < 0.05
    assert 3.0 < coarse_wave / fine_wave < 5.0 and 3.0 < coarse_heat / fine_heat < 5.0


def test_changes_keep_the_shape_and_not_the_mesh() -> None:
    ball = icosphere(3)
    found = {change: people.seen_again(ball, change, 3) for change in people.MESH_CHANGES}
    counts = [len(surface.mesh.vertices) for surface in found.values()]
    assert counts == [642, 642, 321, 160, 642]
    for change, surface in found.items():
        assert abs(surface.mesh.area / ball.mesh.area - 1) < 0.06, change
    assert found["original"] is ball
    shift = found["noise"].mesh.vertices - ball.mesh.vertices
    assert shift.std() == pytest.approx(0.1 * ball.mesh.edge_length, rel=0.05)
    nearest = np.abs(found["resampled"].mesh.vertices[:, None] - ball.mesh.vertices).sum(axis=2).min(axis=1)
    assert (nearest > 1e-6).mean() > 0.5
    with pytest.raises(ValueError, match="change 'melted' is unknown, choose one of original, resampled"):
        people.seen_again(ball, "melted")  # type: ignore[arg-type]


def test_only_the_boundary_is_shaken() -> None:
    inside = np.zeros((12, 12, 12), bool)
    inside[3:9, 3:9, 3:9] = True
    core, hull = np.zeros_like(inside), np.zeros_like(inside)
    core[4:8, 4:8, 4:8] = True
    hull[2:10, 3:9, 3:9] = hull[3:9, 2:10, 3:9] = hull[3:9, 3:9, 2:10] = True
    np.testing.assert_array_equal(people.shaken_boundary(inside, 0.0), inside)
    np.testing.assert_array_equal(people.shaken_boundary(inside, 1.0), core | (hull & ~inside))
    some = people.shaken_boundary(inside, 0.2, 1) ^ inside
    assert not (some & (core | ~hull)).any() and 0.1 < some.sum() / (hull & ~core).sum() < 0.3
    with pytest.raises(ValueError, match="share of voxels that change sides is 2, must be between 0 and 1"):
        people.shaken_boundary(inside, 2.0)


@pytest.fixture
def ball_of_voxels(monkeypatch: pytest.MonkeyPatch) -> LabelVolume:
    axes = np.arange(24) - 11.5
    squares = axes[:, None, None] ** 2 + axes[None, :, None] ** 2 + 1.4 * axes[None, None, :] ** 2
    volume = LabelVolume((squares < 64.0).astype(np.int64), np.diag([2.0, 2.0, 2.0, 1.0]))
    monkeypatch.setattr(people, "label_volume", lambda donor: volume)
    monkeypatch.setattr(people, "label_of", lambda structure, hemisphere: 1)
    return volume


def test_a_person_is_one_field_whatever_the_change(ball_of_voxels: LabelVolume) -> None:
    def person(number: int, change: people.Change = "original") -> Surface:
        return people.subcortical_person("10021", "caudate", "left", number, change, 500)

    plain = surface_of_label(ball_of_voxels, 1, 1.3, 500)
    first, second, again = person(0), person(1), person(0, "segmented")
    assert first.name == "left caudate of 10021, person 0, original"
    steps = first.mesh.vertices - plain.mesh.vertices
    field = random_displacement(plain.mesh.vertices, 0.03, 30.0, 2 * people.PRIME)
    np.testing.assert_allclose(steps, field, atol=1e-12)
    assert not np.array_equal(first.mesh.vertices, second.mesh.vertices)
    assert len(again.mesh.vertices) == 500 and abs(again.mesh.area / first.mesh.area - 1) < 0.1
    rough = people.shaken_boundary(ball_of_voxels.labels == 1, 0.1, 2 * people.PRIME)
    other = surface_of_label(LabelVolume(rough.astype(np.int64), ball_of_voxels.affine), 1, 1.6, 500)
    moved = random_displacement(other.mesh.vertices, 0.03, 30.0, 2 * people.PRIME)
    np.testing.assert_allclose(again.mesh.vertices, other.mesh.vertices + moved, atol=1e-12)
    assert len(person(0, "half").mesh.vertices) == 250
    for number, change in ((-1, "original"), (0, "melted")):
        with pytest.raises(ValueError, match=f"number = {number}, change = '{change}': 0 or more"):
            person(number, change)  # type: ignore[arg-type]


def test_cortical_people_differ_and_are_the_same_again() -> None:
    template = ellipsoid(3, (10.0, 14.0, 12.0))
    first, again, second = (people.cortical_person(template, number) for number in (0, 0, 1))
    np.testing.assert_array_equal(first.mesh.vertices, again.mesh.vertices)
    assert np.abs(first.mesh.area - second.mesh.area) > 1e-6 and first.name == "cortex of person 0, original"
    assert len(people.cortical_person(template, 0, "quarter").mesh.vertices) == 160


def test_answers_are_read_off_and_ties_are_wrong() -> None:
    distances = np.array([[0.0, 1, 2, 3], [0, 1, 2, 3], [5, 5, 1, 1], [9, 9, 1, 0.5]])
    found = recognition(distances, ["a", "a", "b", "b"])
    assert found.nearest.tolist() == [0, 0, -1, 3] and found.right.tolist() == [True, False, False, True]
    assert found.rank_one() == (0.5, *exact_interval(2, 4)) and found.donor_right() == 0.75
    share, low, high = found.by_donor()
    assert share == 0.5 and low == high == 0.5
    assert recognition(distances, ["a", "b", "c", "d"]).by_donor()[1] < 0.5
    with pytest.raises(ValueError, match=r"distances have shape \(4, 4\), \(3, 3\) finite ones are needed"):
        recognition(distances, ["a"] * 3)
    with pytest.raises(ValueError, match="finite"):
        recognition(np.full((2, 2), np.nan), ["a", "b"])


def test_people_are_arranged_and_missing_ones_refused() -> None:
    def members(*rows: tuple[str, str, float | None]) -> dict[Member, int]:
        return {Member(f"{i}", *row): i for i, row in enumerate(rows)}

    mixed = members(("half", "a", 1.0), ("original", "b", 0.0), ("half", "b", 0.0), ("original", "a", 1.0))
    assert by_change(mixed) == {"original": {("b", 0.0): 1, ("a", 1.0): 3}, "half": {("b", 0.0): 2, ("a", 1.0): 0}}
    assert [list(found.values()) for found in by_change(mixed).values()] == [[1, 3], [2, 0]]
    with pytest.raises(ValueError, match="has no level"):
        by_change(members(("original", "a", None)))
    with pytest.raises(ValueError, match="2 subjects of class 'original' and 0 changes"):
        by_change(members(("original", "a", 0.0), ("original", "a", 1.0)))
    with pytest.raises(ValueError, match="change 'half' has 1 subjects, 'original' has 2"):
        by_change(members(("original", "a", 0.0), ("original", "a", 1.0), ("half", "a", 0.0)))


def test_reliability_of_people_and_of_donors() -> None:
    rng = np.random.default_rng(0)
    donors, donor = ["a"] * 6 + ["b"] * 6 + ["c"] * 6, np.repeat([0.0, 10.0, 20.0], 6)[:, None, None]
    same = np.tile(rng.normal(size=(18, 1, 3)), (1, 2, 1))
    assert median_reliability(same, donors) == pytest.approx((1.0, 1.0, 1.0))
    # within donors nothing is reliable, between them all is
    mixed = donor + rng.normal(size=(18, 2, 3))
    share, low, high = median_reliability(mixed, donors)
    assert low <= share <= high and share > 0.9 and reliability_within(mixed, donors) < 0.5
    one = median_reliability(mixed, ["a"] * 18)
    assert one[0] == share and 0.8 < one[1] < share < one[2]
    assert median_reliability(mixed, donors)[1:] != one[1:]
    constant = np.concatenate([mixed, np.ones((18, 2, 2))], axis=2)
    assert constant_entries(constant) == 2 and median_reliability(constant, donors)[0] == share
    assert np.isnan(median_reliability(np.ones((18, 2, 2)), donors)).all()


def planted(shift: float = 0.0, swapped: bool = False, lost: float = 0.0) -> dict[Member, Signature]:
    """Six people of two donors, who are 1 apart, with shape DNA only."""
    found = {}
    for change in ("original", "half", "noise"):
        for k in range(6):
            place = (k ^ 1) if swapped and change == "half" else k
            values = np.array([10.0 + place, 20.0 + place**2]) + (shift if change == "noise" else 0.0)
            parts = {"usual shape_dna": values + (lost if (change, k) == ("half", 2) else 0.0)}
            parts |= {name: np.full(2, 1e-6) for name in ("radii shape_dna", "radii usual shape_dna")}
            found[Member(f"{change} {k}", change, "ab"[k // 3], float(k))] = Signature(values, "shape_dna", parts)
    return found


def test_identification_of_planted_people() -> None:
    plain = identification(planted(), "shape_dna")
    assert plain.rows == ("half", "noise", "all") and plain.metrics["people"] == 6
    assert plain.metrics["rank_one"] == plain.metrics["rank_one half"] == plain.metrics["icc"] == 1.0
    assert plain.metrics["rank_one_low"] == exact_interval(12, 12)[0]
    assert plain.metrics["beyond_certificate"] == plain.metrics["answers_changed"] == plain.metrics["usual_shift"] == 0
    assert plain.metrics["descriptors"] == 18 and plain.metrics["largest_certificate"] == pytest.approx(1e-7)
    swapped = identification(planted(swapped=True), "shape_dna").metrics
    assert swapped["rank_one half"] == 0 and swapped["rank_one noise"] == 1 and swapped["rank_one"] == 0.5
    assert swapped["icc"] < 1 and swapped["centred_rank_one"] == 0.5
    moved = identification(planted(shift=40.0), "shape_dna").metrics
    assert moved["rank_one noise"] == 1 / 6 and moved["centred_rank_one noise"] == moved["centred_rank_one"] == 1


def test_weights_and_donors_of_an_identification() -> None:
    swapped = identification(planted(swapped=True), "shape_dna")
    # 2 and 3 are of different donors
    np.testing.assert_allclose(swapped.columns["donor"], [4 / 6, 1.0, 5 / 6])
    np.testing.assert_allclose(swapped.columns["rank_one_by_donor"][:, 0], [0.0, 1.0, 0.5])
    assert swapped.columns["icc"].shape == (3, 3) and swapped.columns["icc_within"].shape == (3,)
    found = planted()
    for member, signature in found.items():
        # the second entry misleads, and weighs nothing with a large alpha
        if member.class_name == "noise":
            found[member] = replace(signature, values=signature.values * [1.0, -1.0])
    assert identification(found, "shape_dna", 0.0).metrics["rank_one noise"] < 1
    assert identification(found, "shape_dna", 20.0).metrics["rank_one noise"] == 1


def test_a_lost_eigenvalue_is_beyond_the_certificate_and_changes_answers() -> None:
    small = identification(planted(lost=1.9e-6), "shape_dna").metrics
    assert small["beyond_certificate"] == 0 and 1e-6 < small["usual_shift"] < 3e-6
    beyond = identification(planted(lost=2.1e-6), "shape_dna").metrics
    assert beyond["beyond_certificate"] == pytest.approx(1 / 18) and beyond["answers_changed"] == 0
    lost = identification(planted(lost=2.6), "shape_dna").metrics
    assert lost["usual_rank_one"] < 1 and lost["answers_changed"] > 0


def test_two_routes_agree_on_a_real_surface(seen: Signature) -> None:
    for name in DESCRIPTORS:
        np.testing.assert_allclose(seen.part(f"usual {name}"), seen.part(name), rtol=1e-5, atol=1e-8)
    for name in ("shape_dna", "brainprint"):
        covered = seen.part(f"radii {name}") + seen.part(f"radii usual {name}")
        assert (np.abs(seen.part(f"usual {name}") - seen.part(name)) <= covered).all()


@pytest.mark.parametrize("method", ["mean_hausdorff", "block_orthogonal"])
def test_ellipsoids_are_recognised_by_distances_of_pairs(method: str) -> None:
    found = {}
    for k, axis in enumerate((1.5, 1.9, 2.4)):
        body = ellipsoid(2, (1.0, 1.25, axis))
        for change in ("original", "noise"):
            surface = people.seen_again(body, change, k)
            system = surface_spectrum(surface, fem(surface.mesh), 8)
            embedded = spectral_embedding(system, surface.mesh.vertex_areas, 3)
            found[Member(f"{k} {change}", change, "ab"[k // 2], float(k))] = embedded
    table = pairwise_identification(found, Pairing(method=method))  # type: ignore[arg-type]
    assert table.metrics["rank_one"] == table.metrics["rank_one noise"] == 1 and table.metrics["pairs"] == 9
    assert table.rows == ("noise", "all") and table.metrics["rank_one_low"] == exact_interval(3, 3)[0]
    assert table.metrics["proved"] == (1.0 if method == "mean_hausdorff" else 0.0)
    np.testing.assert_array_equal(table.columns["donor"], [1.0, 1.0])


def test_a_picture_of_groups_is_the_same_twice_and_not_of_nothing() -> None:
    groups = {"one": {"half": np.array([0.5, 0.2, 0.8]), "noise": np.array([1.0, 0.9, 1.0])}, "two": {}}
    first, second = (
        grouped_intervals(groups, x_label="share", reference=0.1, reference_name="chance", title="t", width=400)
        for _ in range(2)
    )
    assert (first.pixels == second.pixels).all() and first.pixels.std() > 5 and first.svg.startswith("<svg")
    with pytest.raises(ValueError, match="1 groups have no interval, at least 1 is needed"):
        grouped_intervals({"two": {}}, x_label="share")
