"""Synthetic subjects, sulcal regions, their names and lengths, and the paired tests on them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.populations import synthetic_subject as population
from surfexp.populations.synthetic_subject import random_displacement, stretch, synthetic_subject
from surfexp.statistics.paired_tests import paired_tests, power_by_subjects, rate_in_halves
from surfexp_studies.sulci.asymmetry import asymmetry_study, measured, power_study
from surfexp_studies.sulci.length_table import chosen, length_columns, table_of
from surfexp_studies.sulci.population_study import measure_population, name_regions
from surfexp_studies.sulci.sulcal_lengths import (
    carried_ends,
    carried_vertex,
    closed_region,
    geodesic_lengths,
    region_ends,
)
from surfexp_studies.sulci.sulcal_lines import sulcal_line
from surfexp_studies.sulci.sulcal_measurement import measure_sulci
from surfexp_studies.sulci.sulcal_regions import (
    components,
    names_by_distance,
    names_by_majority,
    naming_accuracy,
    sulcal_regions,
)
from surfexp_studies.sulci.sulcal_template import make_template


@pytest.fixture(scope="module")
def cortex():
    return fsaverage5("left", "pial")


@pytest.fixture(scope="module")
def template(cortex):
    return make_template(cortex, 2)


def test_displacements_have_the_strain_that_is_asked_for() -> None:
    rng = np.random.default_rng(0)
    points = rng.uniform(-60, 60, (4000, 3))
    step = 1e-4
    for strain in (0.02, 0.1):
        found = []
        for seed in range(6):
            base = random_displacement(points, strain, 50.0, seed)
            slopes = [
                (random_displacement(points + step * axis, strain, 50.0, seed) - base) / step for axis in np.eye(3)
            ]
            # all nine derivatives; each of three directions has a third of the squares
            found.append(np.sqrt(np.mean(np.sum(np.square(slopes), axis=0))))
        assert np.mean(found) == pytest.approx(strain, rel=0.15)


def test_a_stretch_lengthens_its_region_and_nothing_far_away() -> None:
    points = np.stack([np.linspace(-50, 50, 201), np.zeros(201), np.zeros(201)], axis=1)
    inside = np.abs(points[:, 0]) < 10
    moved = stretch(points, inside, 0.06)
    length = np.ptp(moved[inside, 0])
    assert length == pytest.approx(1.06 * np.ptp(points[inside, 0]), rel=1e-9)
    assert np.abs(moved - points)[np.abs(points[:, 0]) > 40].max() < 0.01
    with pytest.raises(ValueError, match="at least 3 are needed"):
        stretch(points, np.zeros(201, bool), 0.1)


def test_subjects_repeat_differ_and_mirror(cortex) -> None:
    first = synthetic_subject(cortex, 0, "left", remeshed=False)
    again = synthetic_subject(cortex, 0, "left", remeshed=False)
    assert np.array_equal(first.mesh.vertices, again.mesh.vertices)
    other = synthetic_subject(cortex, 0, "right", remeshed=False)
    assert other.mesh.is_closed and other.mesh.genus == 0
    outward = (other.mesh.face_cross_products * (other.mesh.vertices[other.mesh.faces].mean(axis=1))).sum()
    assert outward > 0
    assert not np.allclose(np.sort(first.mesh.areas), np.sort(other.mesh.areas))
    assert abs(first.mesh.area / cortex.mesh.area - 1.0) < 0.05
    assert synthetic_subject(cortex, 1, "left").metrics["vertices"] > 8000
    with pytest.raises(ValueError, match="choose left or right"):
        synthetic_subject(cortex, 0, "middle")


def test_without_strain_the_sides_are_mirror_images_triangle_by_triangle(cortex) -> None:
    left, right = (synthetic_subject(cortex, 0, side, strain=0.0) for side in ("left", "right"))
    assert np.sort(left.mesh.areas) == pytest.approx(np.sort(right.mesh.areas), rel=1e-9)
    assert len(np.intersect1d(left.truth.origin, right.truth.origin)) == len(np.unique(left.truth.origin))


def test_components_of_two_caps() -> None:
    mesh = icosphere(4).mesh
    z = mesh.vertices[:, 2]
    labels = components(mesh, (z > 0.6) | (z < -0.8))
    assert (labels[z > 0.6] == 0).all() and (labels[z < -0.8] == 1).all()
    assert (labels[np.abs(z) < 0.5] == -1).all()
    assert components(mesh, (z > 0.6) | (z < -0.8), 2.0).max() == 0
    with pytest.raises(ValueError, match="the mask has shape"):
        components(mesh, np.ones(3, bool))


def test_regions_of_the_cortex_lie_in_sulci(cortex) -> None:
    regions = sulcal_regions(cortex.mesh)
    assert 15 <= regions.max() + 1 <= 45
    depth = cortex.scalars["sulc"]
    assert depth[regions >= 0].mean() > 0 > depth[regions < 0].mean()
    sizes = np.bincount(regions[regions >= 0], cortex.mesh.vertex_areas[regions >= 0])
    assert (np.diff(sizes) <= 1e-9).all() and sizes.min() > 1.5e-3 * cortex.mesh.area


def test_names_by_hand() -> None:
    regions, areas = np.array([0, 0, 0, 1, 1, -1]), np.array([1.0, 1.0, 1.0, 1.0, 5.0, 1.0])
    template = np.array([0, 1, -1])
    rows = np.array([0, 0, 1, 0, 1, 2])
    assert names_by_majority(regions, areas, template, rows).tolist() == [0, 1]
    assert names_by_majority(regions, areas, template, np.full(6, 2)).tolist() == [-1, -1]
    points = np.array([[0.0], [0.1], [0.2], [1.0], [1.1], [5.0]])
    found = names_by_distance(regions, areas, points, np.array([0, 1]), np.ones(2), np.array([[1.0], [0.1]]))
    assert found.tolist() == [1, 0]
    assert naming_accuracy(np.array([0, 1]), np.array([0, 0]), regions, areas) == pytest.approx(3.0 / 9.0)
    assert naming_accuracy(np.array([0, 1]), np.array([0, -1]), regions, areas) == 1.0


def test_names_by_distance_look_both_ways() -> None:
    """A region inside one template region, and one around it, both belong to the neighbour of their own extent."""
    small, wide = np.array([[0.0]]), np.array([[0.0], [10.0]])
    for points, template_points, template in (
        (small, np.array([[0.0], [10.0], [1.0]]), np.array([0, 0, 1])),
        (wide, np.array([[0.0], [1.0], [9.0]]), np.array([0, 1, 1])),
    ):
        count = len(points)
        found = names_by_distance(
            np.zeros(count, np.int64), np.ones(count), points, template, np.ones(3), template_points
        )
        assert found.tolist() == [1]
    # an end of little area hardly counts, in either direction
    rare = np.array([1.0, 1e-3])
    found = names_by_distance(
        np.zeros(2, np.int64), rare, wide, np.array([0, 1, 1]), np.ones(3), np.array([[0.0], [1.0], [9.0]])
    )
    assert found.tolist() == [0]
    found = names_by_distance(
        np.zeros(1, np.int64),
        np.ones(1),
        small,
        np.array([0, 0, 1]),
        np.append(rare, 1.0),
        np.array([[0.0], [10.0], [1.0]]),
    )
    assert found.tolist() == [0]


def test_a_strip_has_its_length() -> None:
    mesh = icosphere(5).mesh
    longitude = np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0])
    strip = (np.abs(mesh.vertices[:, 2]) < 0.08) & (np.abs(longitude) < 0.8)
    start, end = region_ends(mesh, strip)
    assert geodesic_lengths(mesh, [(start, end), (start, start)]) == pytest.approx([1.6, 0.0], rel=0.06)
    assert carried_ends(mesh, np.arange(len(mesh.vertices)), (start, end)) == (start, end)
    places = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -3.0], [0.4, 0.0, 0.0]])
    assert carried_vertex(places, np.zeros(3)) == 2
    line = sulcal_line(mesh, strip)
    assert line.chain
    assert line.lengths["line with ends"] == pytest.approx(1.6, rel=0.03)
    assert line.lengths["geodesic"] == pytest.approx(1.6, rel=0.03)
    assert line.lengths["mean distance"] == pytest.approx(1.6, rel=0.03)
    # of a cosine, the outermost of 50 uniform levels leave a tenth at either end
    share = 1.0 - 2.0 / np.pi * np.arccos(1.0 - 2.0 / 51.0)
    assert line.lengths["published line"] == pytest.approx(share * 1.6, rel=0.03)
    assert np.linalg.norm(line.points, axis=1) == pytest.approx(1.0, abs=0.01)
    assert np.abs(line.points[:, 2]).max() < 0.08
    with pytest.raises(ValueError, match="no whole face"):
        region_ends(mesh, np.arange(len(mesh.vertices)) == 7)


def test_regions_of_a_subject_are_named(template, cortex) -> None:
    subject = synthetic_subject(cortex, 3, "right")
    scores = name_regions(template, subject, (4,))
    assert scores["majority, ZoomOut"] > 0.97
    assert scores["published rule, n = 4"] > 0.85
    assert scores["regions"] == len(np.setdiff1d(sulcal_regions(subject.mesh), [-1]))


def test_a_ring_of_growth_and_shrinking_closes_a_gap_and_no_more() -> None:
    mesh = icosphere(3).mesh
    cap = mesh.vertices[:, 2] > 0.3
    whole = closed_region(mesh, cap)
    assert (whole >= cap).all() and closed_region(mesh, whole).sum() == whole.sum()
    torn = whole.copy()
    torn[np.flatnonzero(mesh.vertices[:, 2] > 0.8)[0]] = False
    assert np.array_equal(closed_region(mesh, torn), whole)
    assert not closed_region(mesh, np.zeros(len(cap), bool)).any()


@pytest.mark.slow
def test_a_bare_file_gives_the_lengths_of_the_surface_in_memory(template, cortex, tmp_path) -> None:
    target = synthetic_subject(cortex, 2, "right", seed=3)
    write_mesh(tmp_path / "subject.off", target.mesh)
    vertices, faces, maps = read_mesh(tmp_path / "subject.off")
    assert maps == {}
    bare = measure_sulci(template, Surface(TriangleMesh(vertices, faces)))
    known = measure_sulci(template, target)
    assert set(known) - set(bare) == {"true"}
    for name, lengths in bare.items():
        assert lengths == pytest.approx(known[name], rel=1e-6), name
    assert known["carried ends"] == pytest.approx(known["true"], rel=0.12)


@pytest.mark.slow
def test_mirrored_surfaces_have_equal_lengths_so_sides_may_be_exchanged(template, cortex) -> None:
    target = synthetic_subject(cortex, 4, "left", remeshed=False, seed=3)
    mirror = TriangleMesh(target.mesh.vertices * [1.0, 1.0, -1.0], target.mesh.faces[:, ::-1])
    first, second = measure_sulci(template, target), measure_sulci(template, Surface(mirror))
    for name, lengths in second.items():
        assert lengths == pytest.approx(first[name], rel=0.02), name


@pytest.fixture(scope="module")
def lengths():
    """Lengths of 30 subjects, 2 sides and 2 sulci by two estimators, the first sulcus 4 longer left."""
    rng = np.random.default_rng(1)
    table = {}
    for name, noise in (("true", 1.0), ("rough", 8.0)):
        left, right = rng.normal(100.0, noise, (2, 30, 2))
        table[name] = {"left": left + np.array([4.0, 0.0]), "right": right}
    return table


def test_the_table_of_lengths_is_read_back_from_blocks_in_any_order(lengths) -> None:
    blocks = [
        length_columns({e: {side: rows[part] for side, rows in sides.items()} for e, sides in lengths.items()}, part)
        for part in (range(20, 30), range(20))
    ]
    rows, columns = blocks[0]
    assert rows[3] == "subject 20, right, sulcus 2"
    assert (columns["subject"][3], columns["side"][3], columns["sulcus"][3]) == (20.0, 1.0, 2.0)
    found = table_of(columns for _, columns in blocks)
    for name, sides in lengths.items():
        for side, values in sides.items():
            assert np.array_equal(found[name][side], values)
    assert list(chosen(found, ["rough"])) == ["rough"] and list(chosen(found, [])) == ["true", "rough"]
    with pytest.raises(ValueError, match="do not list 30 subjects"):
        table_of([columns for _, columns in blocks] + [blocks[0][1]])
    with pytest.raises(ValueError, match="take tables made alike"):
        table_of([blocks[0][1], {**blocks[1][1], "more": np.zeros(80)}])
    with pytest.raises(ValueError, match="'exact' is unknown, choose from true, rough"):
        chosen(found, ["exact"])


@pytest.mark.slow
def test_exchanging_sides_changes_the_sign_of_every_asymmetry(lengths) -> None:
    rows, columns, metrics = asymmetry_study(lengths)
    swapped = {name: {"left": sides["right"], "right": sides["left"]} for name, sides in lengths.items()}
    others, mirrored, numbers = asymmetry_study(swapped)
    assert rows == others and len(rows) == 4
    for name in ("difference", "effect"):
        assert mirrored[name] == pytest.approx(-columns[name], rel=1e-12)
    assert mirrored["effect_low"] == pytest.approx(-columns["effect_high"])
    for name in ("p_t", "p_t_holm", "p_wilcoxon", "p_wilcoxon_holm"):
        assert mirrored[name] == pytest.approx(columns[name])
    assert metrics["difference, true"] == pytest.approx(0.04, abs=0.006)
    assert numbers["difference, true"] == -metrics["difference, true"]
    assert metrics["p, true"] < 1e-6 < 0.05 < metrics["least p elsewhere, true"]


@pytest.mark.slow
def test_a_rough_estimator_needs_more_subjects_and_a_missing_one_is_left_out(lengths) -> None:
    power = power_study(lengths, [5, 10, 30], 400)
    assert (power["true"] >= power["rough"]).all() and power["rough"][0] < power["rough"][2]
    nothing = {side: np.full((30, 2), np.nan) for side in ("left", "right")}
    rows, _, metrics = asymmetry_study({**lengths, "none": nothing})
    assert len(rows) == 4 and "p, none" not in metrics
    assert measured({**lengths, "none": nothing})[1] == (
        "none is left out: 0 complete pairs of sulcus 1, at least 3 are needed.",
    )
    shorter = {side: 0.8 * values for side, values in lengths["true"].items()}
    lines = {"own region, published line": shorter, "own region, line with ends": lengths["true"]}
    assert asymmetry_study(lines)[2]["published share of line"] == pytest.approx(0.8)
    with pytest.raises(ValueError, match="take at least 3 subjects with both sides"):
        power_study({"none": nothing}, [5])
    two = {side: rows[:2] for side, rows in lengths["true"].items()}
    with pytest.raises(ValueError, match="take at least 3 subjects with both sides"):
        asymmetry_study({"true": two})


@pytest.mark.slow
def test_the_planted_difference_is_found(template) -> None:
    table = measure_population(template, range(8), asymmetry=0.1)
    _, _, metrics = asymmetry_study(table)
    assert metrics["difference, true"] == pytest.approx(0.09, abs=0.025)
    assert metrics["effect, carried ends"] > 0 and metrics["p, carried ends"] < 0.05


@pytest.mark.slow
def test_paired_tests_agree_with_scipy_and_holm_by_hand() -> None:
    rng = np.random.default_rng(2)
    left = {name: rng.normal(10.0 + shift, 1.0, 40) for name, shift in (("a", 1.0), ("b", 0.5), ("c", 0.0))}
    right = {name: rng.normal(10.0, 1.0, 40) for name in "abc"}
    left["c"][3] = np.nan
    tests = paired_tests(left, right)
    assert tests.p_t[0] == pytest.approx(stats.ttest_rel(left["a"], right["a"]).pvalue)
    assert tests.p_wilcoxon[1] == pytest.approx(stats.wilcoxon(left["b"], right["b"]).pvalue)
    assert tests.subjects.tolist() == [40, 40, 39]
    order = np.argsort(tests.p_t)
    holm = np.minimum(np.maximum.accumulate(tests.p_t[order] * [3, 2, 1]), 1.0)
    assert tests.p_t_holm[order] == pytest.approx(holm)
    assert tests.effect_low[0] < tests.effect[0] < tests.effect_high[0]
    assert paired_tests(right, left).effect == pytest.approx(-tests.effect)
    same = paired_tests({"x": np.arange(5.0)}, {"x": np.arange(5.0)})
    assert same.p_t[0] == 1.0 and same.effect[0] == 0.0
    with pytest.raises(ValueError, match="at least 3 are needed"):
        paired_tests({"x": np.array([1.0, np.nan, 2.0])}, {"x": np.ones(3)})
    with pytest.raises(ValueError, match="pairs are needed"):
        paired_tests({"x": np.ones(4)}, {"x": np.ones(3)})


def test_halves_of_a_population_are_quiet_without_a_bias_and_show_one_that_is_planted() -> None:
    rng = np.random.default_rng(5)
    samples = [rng.normal(0.0, 1.0, 40) for _ in range(10)]
    without = [rate_in_halves(sample - sample.mean(), 400, seed=k) for k, sample in enumerate(samples)]
    assert max(without) <= 0.05
    biased = [rate_in_halves(sample + 1.0, 400, seed=k) for k, sample in enumerate(samples)]
    assert min(biased) > 0.9
    assert rate_in_halves(np.append(samples[0] + 10.0, np.nan)) == 1.0


def test_power_grows_with_the_subjects() -> None:
    rng = np.random.default_rng(5)
    power = power_by_subjects(rng.normal(0.6, 1.0, 200), [5, 20, 80], 300)
    assert power[0] < power[1] < power[2] and power[2] > 0.95


def test_both_sides_share_half_of_the_square_of_the_strain(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: dict[str, list[tuple[float, int]]] = {"left": [], "right": []}
    template = Surface(icosphere(2).mesh, "ball")
    for side, calls in drawn.items():

        def displaced(points: np.ndarray, strain: float, wavelength: float, seed: int, into=calls) -> np.ndarray:
            into.append((strain, seed))
            return np.zeros_like(points)

        monkeypatch.setattr(population, "random_displacement", displaced)
        synthetic_subject(template, 4, side, 0.06, remeshed=False)
    assert sum(strain**2 for strain, _ in drawn["left"]) == pytest.approx(0.06**2)
    assert drawn["left"][0] == drawn["right"][0] and drawn["left"][0][0] == drawn["left"][1][0]
    assert len({seed for calls in drawn.values() for _, seed in calls}) == 3
