"""The test at every vertex: its short forms, its mask, its table, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import false_discovery_control
from scipy.stats import t as student

import surfexp as sx
from surfexp.inference.linear_model import contrast_model
from surfexp.inference.permutation_inference import Statistics, null_distributions
from surfexp.inference.rearrangements import sign_flips
from surfexp.inference.vertex_graph import vertex_graph
from surfexp.io.map_files import read_maps
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface_part import surface_part
from surfexp.mesh.union_find import components as components_of

BALL = sx.shape("icosphere", levels=2)
N = len(BALL.mesh.vertices)
HEIGHT = BALL.mesh.vertices[:, 2]
NOISE = np.random.default_rng(0).standard_normal((N, 10))
EFFECT = 2.5 * (HEIGHT > 0.6)[:, None]
GROUPS = np.array(["old", "old", "young", "old", "young", "young", "old", "young", "old", "young"])
PAIRS = np.array([0, 1, 1, 2, 0, 2, 3, 3, 4, 4])


def components(edges: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Number of the component of each vertex inside, -1 outside."""
    return np.where(inside, components_of(edges[inside[edges].all(axis=1)], len(inside)), -1)


def same(one: sx.tasks.tested_maps.PermutationTest, other: sx.tasks.tested_maps.PermutationTest) -> None:
    for name, values in one.maps.items():
        np.testing.assert_allclose(values, other.maps[name], rtol=1e-9, err_msg=name)


def test_an_effect_is_found_where_it_is() -> None:
    found = sx.permutation_test(BALL, NOISE + EFFECT, count=2000)
    inside = EFFECT[:, 0] > 0
    assert found.facts["exact"] and found.facts["rearrangements"] == "all 1,024 sign flips that differ"
    assert (found.p_tfce[inside] < 0.05).mean() > 0.9 and (found.p_tfce[~inside] < 0.05).mean() < 0.2
    assert found.facts["least p"] == 2 / 1024 == found.p_tfce.min()
    (region,) = found.regions
    assert region.vertices == (found.p_tfce <= 0.05).sum() and inside[region.peak] and region.t == np.abs(found.t).max()
    assert region.area == pytest.approx(BALL.mesh.vertex_areas[found.p_tfce <= 0.05].sum())
    assert region.place == tuple(BALL.mesh.vertices[region.peak])
    members = np.abs(found.t) >= found.facts["threshold"]
    assert sum(one.vertices for one in found.clusters) == members.sum()
    assert (found.p_extent[~members] == 1.0).all() and found.p_extent[members].min() == found.clusters[0].p_extent
    assert len(found.table()["p_mass"]) == len(found.clusters) and "p_mass" not in found.table("regions")
    assert found.facts["threshold"] == pytest.approx(student.isf(0.0005, 9))


def test_the_table_and_the_corrections_are_those_of_the_maps() -> None:
    """On an irregular surface with a mask, whose vertices have other numbers than those of the part."""
    points = BALL.mesh.vertices * [1.0, 1.4, 2.0]
    mask, parcels = (
        (HEIGHT > -0.4) & (np.arange(N) > 5),
        LabelMap((points[:, 0] > 0.3).astype(int), {0: "left", 1: "right"}),
    )
    body, effect = sx.Surface((points, BALL.mesh.faces), mask=mask), 1.2 * np.sin(3.0 * HEIGHT)[:, None]
    found = sx.permutation_test(body, NOISE + effect, forming_p=0.05, labels=parcels, level=0.3)
    kept = np.flatnonzero(np.isfinite(found.t))
    assert kept[0] > 0 and len(found.clusters) > 3 and len(found.regions) > 1
    part = surface_part(body.mesh, mask)
    t, areas, edges = found.t[kept], part.mesh.vertex_areas, part.mesh.edges
    for rows, beyond in (
        (found.clusters, np.abs(t) >= found.facts["threshold"]),
        (found.regions, found.p_tfce[kept] <= 0.3),
    ):
        labels = components(edges, beyond & (t > 0)) + 1000 * (components(edges, beyond & (t <= 0)) + 1)
        sets = [np.flatnonzero(labels == one) for one in np.unique(labels[beyond])]
        sets.sort(key=lambda inside: -(np.abs(t) * areas)[inside].sum())
        assert [one.vertices for one in rows] == [len(inside) for inside in sets]
        for row, inside in zip(rows, sets, strict=True):
            peak = inside[np.abs(t[inside]).argmax()]
            assert row.peak == kept[peak] and row.t == t[peak] and row.place == tuple(points[kept[peak]])
            assert row.area == pytest.approx(areas[inside].sum())
            assert row.mass == pytest.approx((np.abs(t) * areas)[inside].sum())
            assert row.p_t == found.p_t[kept[inside]].min() and row.p_tfce == found.p_tfce[kept[inside]].min()
            share = areas[inside][points[kept[inside], 0] > 0.3].sum() / areas[inside].sum()
            assert row.parcels.get("right", 0.0) == pytest.approx(share)
            if rows is found.clusters:
                for name, size in (("extent", row.area), ("mass", row.mass)):
                    p = (found.null[name] >= size * (1 - 1e-9)).mean()
                    assert getattr(row, f"p_{name}") == found.maps[f"p_{name}"][kept[peak]] == pytest.approx(p)
    for name, q in (("t", found.q_t), ("tfce", found.q_tfce)):
        model = contrast_model((NOISE + effect)[kept].T, np.ones((10, 1)), np.ones(1))
        flips = sign_flips(np.arange(10), 1024, np.random.default_rng(0))
        nulls = null_distributions(model, flips, Statistics(vertex_graph(part.mesh), 2.0))
        np.testing.assert_allclose(q[kept], false_discovery_control(getattr(nulls, f"p_{name}")))


def test_groups_are_the_design_that_they_stand_for() -> None:
    data = NOISE + EFFECT * (GROUPS == "old")
    dummies = np.column_stack([GROUPS == "old", GROUPS == "young"])
    short = sx.permutation_test(BALL, data, groups=GROUPS, count=300)
    same(short, sx.permutation_test(BALL, data, dummies, [1, -1], count=300))
    assert (
        short.facts["rearrangements"] == "all 252 permutations that differ"
        and short.facts["tested"] == "old less young"
    )
    assert np.nanmax(short.t) > 4.0
    reversed_names = np.where(GROUPS == "old", "first", "second")
    same(short, sx.permutation_test(BALL, data, groups=reversed_names, count=300))


def test_labels_are_bytes_and_contrasts_one_row_of_a_matrix() -> None:
    plain = sx.permutation_test(BALL, NOISE, groups=GROUPS, count=40)
    of_bytes = sx.permutation_test(BALL, NOISE, groups=GROUPS.astype("S"), count=40)
    same(of_bytes, plain)
    assert of_bytes.facts["tested"] == plain.facts["tested"] == "old less young"
    design = np.column_stack([GROUPS == "old", GROUPS == "young"])
    same(sx.permutation_test(BALL, NOISE, design, [[1, -1]], count=40), plain)


def test_pairs_are_the_mean_of_their_differences() -> None:
    found = sx.permutation_test(BALL, NOISE, groups=GROUPS, pairs=PAIRS)
    differences = NOISE[:, [0, 1, 3, 6, 8]] - NOISE[:, [4, 2, 5, 7, 9]]
    same(found, sx.permutation_test(BALL, differences))
    # the same test as a model with a column for each pair, permuted within pairs
    model = np.column_stack([GROUPS == "old", *(k == PAIRS for k in range(5))]).astype(float)
    permuted = sx.permutation_test(BALL, NOISE, model, [1, 0, 0, 0, 0, 0], blocks=PAIRS)
    assert permuted.facts["rearrangements"] == "all 32 permutations that differ"
    np.testing.assert_allclose(permuted.t, found.t, rtol=1e-9)
    np.testing.assert_allclose(permuted.p_tfce, found.p_tfce, rtol=1e-9)


def test_pairs_flip_by_the_blocks_of_their_maps() -> None:
    """Blocks have a label for each map, and the differences of pairs are half as many."""
    families = np.array([*"xyyxxxzzyy"])
    found = sx.permutation_test(BALL, NOISE, groups=GROUPS, pairs=PAIRS, blocks=families, exchange="whole")
    differences = NOISE[:, [0, 1, 3, 6, 8]] - NOISE[:, [4, 2, 5, 7, 9]]
    same(found, sx.permutation_test(BALL, differences, blocks=[*"xyxzy"], exchange="whole"))
    assert found.facts["rearrangements"] == "all 8 sign flips that differ"
    assert found.facts["maps"] == 10 and found.facts["differences"] == 5
    with pytest.raises(ValueError, match="pair 4 has maps of the blocks a, b: a pair in one block is needed"):
        sx.permutation_test(BALL, NOISE, groups=GROUPS, pairs=PAIRS, blocks=[*"aaaaaaaaab"], exchange="whole")
    with pytest.raises(ValueError, match=r"blocks have shape \(5,\), one label for each of 10 maps"):
        sx.permutation_test(BALL, NOISE, groups=GROUPS, pairs=PAIRS, blocks=[*"xyxzy"], exchange="whole")


def test_covariates_are_regressed_out() -> None:
    age = np.random.default_rng(1).uniform(20, 80, 10)
    found = sx.permutation_test(BALL, NOISE, groups=GROUPS, covariates=age, count=100)
    moved = sx.permutation_test(
        BALL, NOISE + 0.5 * age * (1.0 + HEIGHT[:, None]), groups=GROUPS, covariates=age, count=100
    )
    np.testing.assert_allclose(moved.t, found.t, rtol=1e-6)
    np.testing.assert_allclose(moved.p_tfce, found.p_tfce)
    assert found.facts["degrees of freedom"] == 7 and not found.facts["exact"]
    every = sx.permutation_test(BALL, NOISE[:, :5], covariates=age[:5])
    assert every.facts["all rearrangements"] and not every.facts["exact"]
    slope = sx.permutation_test(BALL, NOISE[:, :5] + 9.0, np.column_stack([np.ones(5), age[:5]]), [0, 1])
    assert slope.facts["exact"] and slope.facts["rearrangements"] == "all 120 permutations that differ"
    mean = sx.permutation_test(BALL, NOISE, covariates=age, count=100)
    centred = np.column_stack([np.ones(10), age - age.mean()])
    same(mean, sx.permutation_test(BALL, NOISE, centred, [1, 0], count=100))


def test_covariates_count_whatever_their_unit_and_constant_ones_say_nothing() -> None:
    """Mean diffusivity in square metres a second is 7e-10: it was left out without a word."""
    diffusivity = np.random.default_rng(1).uniform(0.6, 0.9, 10)
    data = NOISE + 20.0 * diffusivity
    wanted = sx.permutation_test(BALL, data, groups=GROUPS, covariates=diffusivity, count=60)
    same(sx.permutation_test(BALL, data, groups=GROUPS, covariates=1e-9 * diffusivity, count=60), wanted)
    beside = np.column_stack([diffusivity, np.full(10, 3.3)])
    same(sx.permutation_test(BALL, data, groups=GROUPS, covariates=beside, count=60), wanted)


def test_blocks_bound_what_is_exchanged() -> None:
    families = np.array([0, 0, 0, 0, 0, 1, 1, 1, 1, 1])
    found = sx.permutation_test(BALL, NOISE, groups=GROUPS, blocks=families, count=200)
    # 3 old of 5, times 2 old of 5
    assert found.facts["rearrangements"] == "all 100 permutations that differ"
    whole = sx.permutation_test(BALL, NOISE, blocks=PAIRS, exchange="whole")
    assert whole.facts["rearrangements"] == "all 32 sign flips that differ"
    unequal = sx.permutation_test(BALL, NOISE, blocks=[*"aaabbccdef"], exchange="whole")
    assert unequal.facts["rearrangements"] == "all 64 sign flips that differ"


def test_the_mask_is_where_all_maps_are_known_and_nothing_outside_takes_part() -> None:
    holes, outside = NOISE + EFFECT, HEIGHT < -0.5
    holes[outside, 3] = np.nan
    found = sx.permutation_test(BALL, holes, count=100)
    assert all(np.isnan(values[outside]).all() for values in found.maps.values())
    assert any("these are the mask" in note for note in found.notes)
    masked = sx.permutation_test(
        replace(BALL, mask=~outside), np.where(outside[:, None], 1e6, NOISE + EFFECT), count=100
    )
    same(found, masked)
    both = sx.permutation_test(replace(BALL, mask=HEIGHT < 0.9), holes, count=100)
    same(both, sx.permutation_test(replace(BALL, mask=(HEIGHT < 0.9) & ~outside), NOISE + EFFECT, count=100))
    said = (
        f"The map is NaN at {outside.sum()} of the {(HEIGHT < 0.9).sum()} vertices inside the mask: they are outside."
    )
    assert f"{said} Map 4 of 10 alone is NaN at {outside.sum()}." in both.notes
    assert any(note.endswith(f"Map 4 of 10 alone is NaN at {outside.sum()}.") for note in found.notes)
    everywhere = np.where(outside[:, None], np.nan, NOISE)
    assert not any("alone" in note for note in sx.permutation_test(BALL, everywhere, count=20).notes)


def test_the_map_that_is_known_nowhere_is_named() -> None:
    """Nine of ten were complete, and the line said that the map is NaN at all vertices."""
    lost = NOISE.copy()
    lost[:, 6] = np.nan
    with pytest.raises(ValueError, match=r"map 7 of 10 is NaN at all 162 vertices: give numbers where it is known$"):
        sx.permutation_test(BALL, lost)
    inside = HEIGHT > 0.3
    lost[~inside, 6] = 1.0
    with pytest.raises(ValueError, match=rf"map 7 of 10 is NaN at all {inside.sum()} vertices inside the mask: give"):
        sx.permutation_test(replace(BALL, mask=inside), lost)
    top = HEIGHT > 0.9
    lost[:, 6], lost[:, 2] = np.where(top, np.nan, 1.0), np.where(top, 1.0, np.nan)
    with pytest.raises(
        ValueError, match=rf"none of 162 vertices is known in all maps, map 3 of 10 is NaN at {(~top).sum()}: give"
    ):
        sx.permutation_test(BALL, lost)


def test_two_hemispheres_are_one_surface_of_two_components() -> None:
    mesh = BALL.mesh
    both = np.vstack([mesh.vertices, mesh.vertices + 3.0]), np.vstack([mesh.faces, mesh.faces + N])
    left, right = NOISE + EFFECT, np.random.default_rng(5).standard_normal((N, 10))
    found = sx.permutation_test(both, np.vstack([left, right]), count=2000)
    apart = [sx.permutation_test(BALL, half, count=2000) for half in (left, right)]
    np.testing.assert_allclose(found.tfce, np.concatenate([one.tfce for one in apart]), rtol=1e-9)
    largest = np.maximum(*(one.null["tfce"] for one in apart))
    np.testing.assert_allclose(found.null["tfce"], largest, rtol=1e-9)
    assert (found.p_tfce[:N] >= apart[0].p_tfce).all() and found.facts["exact"]


def test_neither_threads_nor_the_unit_of_length_change_anything() -> None:
    first = sx.permutation_test(BALL, NOISE + EFFECT, count=200, threads=1)
    assert (sx.permutation_test(BALL, NOISE + EFFECT, count=200, threads=2).p_tfce == first.p_tfce).all()
    assert (sx.permutation_test(BALL, NOISE + EFFECT, count=200, seed=1).p_tfce != first.p_tfce).any()
    for unit in (1e-100, 1e3, 1e100):
        other = sx.permutation_test((unit * BALL.mesh.vertices, BALL.mesh.faces), NOISE + EFFECT, count=200)
        np.testing.assert_allclose(other.p_tfce, first.p_tfce)
        np.testing.assert_allclose(other.tfce / unit**2, first.tfce, rtol=1e-9)
        assert other.clusters[0].area == pytest.approx(unit**2 * first.clusters[0].area)
    scaled = sx.permutation_test(BALL, 1e200 * (NOISE + EFFECT), count=200)
    np.testing.assert_allclose(scaled.p_mass, first.p_mass)


def test_one_side() -> None:
    both = sx.permutation_test(BALL, NOISE - EFFECT)
    one = sx.permutation_test(BALL, NOISE - EFFECT, two_sided=False)
    other = sx.permutation_test(BALL, EFFECT - NOISE, two_sided=False)
    assert both.p_tfce.min() < 0.01 < one.p_tfce.min() and other.facts["least p"] == 1 / 1024
    np.testing.assert_allclose(other.p_tfce.min(), both.p_tfce.min() / 2)
    assert (one.p_t[one.t <= 0] == 1.0).all()


def test_parcels_of_clusters() -> None:
    table = LabelMap(np.where(HEIGHT > 0.0, np.where(BALL.mesh.vertices[:, 0] > 0, 1, 2), 0), {1: "front", 2: "back"})
    found = sx.permutation_test(BALL, NOISE + EFFECT, labels=table, count=200)
    shares = found.regions[0].parcels
    assert set(shares) == {"front", "back"} and sum(shares.values()) == pytest.approx(1.0, abs=0.1)
    assert list(shares.values()) == sorted(shares.values(), reverse=True)
    assert found.table("regions")["parcels"][0].count("%") == 2
    carried = replace(BALL, labels={"halves": table})
    assert sx.permutation_test(carried, NOISE + EFFECT, labels="halves", count=200).regions[0].parcels == shares


def test_maps_by_name_are_columns() -> None:
    named = replace(BALL, scalars={f"subject {k}": column for k, column in enumerate(NOISE.T)})
    same(sx.permutation_test(named, list(named.scalars), count=100), sx.permutation_test(BALL, NOISE, count=100))


def test_few_subjects_are_told_that_no_p_can_be_small() -> None:
    found = sx.permutation_test(BALL, NOISE[:, :4])
    assert found.facts["least p"] == 0.125
    assert found.notes[0] == "No p can be under 0.125 with all 16 sign flips that differ: measure more subjects."
    few = sx.permutation_test(BALL, NOISE, count=10)
    assert few.notes[0] == "No p can be under 0.2 with 10 of 1,024 sign flips: raise count."
    design = np.column_stack([np.ones(10), PAIRS])
    within = sx.permutation_test(BALL, NOISE, design, [0, 1], blocks=PAIRS)
    assert within.notes[0] == (
        "No p can be under 1 with all 1 permutations that differ: choose exchange = 'whole' if blocks can change places, "
        "else measure more subjects."
    )
    whole = sx.permutation_test(BALL, NOISE, design, [0, 1], blocks=PAIRS, exchange="whole")
    assert whole.facts["rearrangements"] == "all 120 permutations that differ" and not whole.notes


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"maps": NOISE[:, :1]}, "at least 2 subjects"),
        ({"maps": []}, "at least 2 subjects"),
        ({"maps": NOISE[:5]}, "the surface has 162 vertices"),
        ({"groups": GROUPS[:4]}, "one label for each of 10 maps"),
        ({"groups": np.arange(10)}, "exactly 2 are needed"),
        ({"groups": [*["a", "n/a"] * 5]}, "groups have no label for 5 of 10 maps .the first is number 1, 'n/a'."),
        ({"groups": np.ma.masked_array(GROUPS, [1, *[0] * 9])}, "groups have no label for 1 of 10 maps"),
        ({"groups": GROUPS, "covariates": GROUPS == "old"}, "as a covariate that is the group; leave one out"),
        (
            {"design": np.eye(10)[:, :2], "contrast": np.eye(2)},
            r"contrast has shape \(2, 2\): one row of 2 finite numbers",
        ),
        ({"groups": [None, *["a"] * 9]}, "groups have no label for 1 of 10 maps"),
        ({"blocks": [1, 1, 2, 2, 3, 3, 4, 4, np.nan, np.nan]}, "blocks have no label for 2 of 10 maps"),
        ({"groups": GROUPS, "pairs": ["", "", *"aabbccdd"]}, "pairs have no label for 2 of 10 maps"),
        ({"pairs": PAIRS}, "pairs need groups"),
        ({"groups": GROUPS, "pairs": np.arange(10)}, "pair 0 has the maps old: one old and one young are needed"),
        ({"design": np.ones((10, 2))}, "give a contrast of 2 numbers"),
        ({"design": np.ones((10, 2)), "contrast": [1, 0]}, "cannot be estimated"),
        ({"design": np.arange(10.0)}, "the design has no constant: a slope is tested through 0, add a column of ones"),
        ({"design": np.ones(9)}, "one row for each of 10 maps"),
        ({"design": np.ones(10), "groups": GROUPS}, "a design and groups are given"),
        ({"contrast": [1]}, "without a design"),
        ({"covariates": np.full(10, np.nan)}, "leave these maps out"),
        ({"exchange": "whole"}, "give blocks"),
        ({"blocks": PAIRS}, "signs flip one by one, whatever the blocks: choose exchange = 'whole'"),
        ({"groups": GROUPS, "blocks": PAIRS, "rearrange": "flip"}, "choose exchange = 'whole'"),
        ({"exchange": "none"}, "exchange = 'none', choose one of within, whole"),
        ({"rearrange": "permute"}, "permuting cannot test a mean"),
        ({"count": 1}, "count = 1, 2 to"),
        ({"forming_p": 0.7}, "below 0.5"),
        ({"level": 2}, "level = 2"),
        ({"labels": "none"}, "labels are 'none': there is no such file"),
        ({"extent_power": -1}, "extent_power"),
    ],
)
def test_mistakes_are_told_in_one_line(given: dict, line: str) -> None:
    with pytest.raises(ValueError, match=line) as caught:
        sx.permutation_test(BALL, **{"maps": NOISE} | given)
    assert "\n" not in str(caught.value)


def test_it_is_drawn_with_a_line_at_the_level_and_written() -> None:
    from surfexp.tasks.shown import shown_surfaces

    found = sx.permutation_test(BALL, NOISE + EFFECT, count=200)
    (t,), (p,) = shown_surfaces(BALL, found)
    np.testing.assert_array_equal(t.values, found.t)
    np.testing.assert_allclose(p.values, -np.log10(found.p_tfce))
    (line,) = p.contours
    assert line.levels == pytest.approx((-np.log10(0.05),)) and t.scale.limits[0] == -t.scale.limits[1]


def test_all_maps_are_written_and_read(working_folder: object) -> None:
    found = sx.permutation_test(BALL, NOISE, count=50)
    sx.write("found.npz", found.maps, BALL)
    with np.load("found.npz") as again:
        assert set(found.maps) <= set(again.files)
        np.testing.assert_array_equal(again["p_tfce"], found.p_tfce)


@pytest.mark.parametrize("name", ["test.npz", "test.func.gii", "test.csv", "test.vtp"])
def test_a_result_is_written_with_all_its_maps(working_folder: object, name: str) -> None:
    """Only t was, as "map"."""
    found = sx.permutation_test(BALL, NOISE, count=20)
    sx.write(name, found, BALL)
    again = sx.read(name).scalars if name.endswith(".vtp") else read_maps(name)
    assert list(again) == list(found.maps)
    for column, values in found.maps.items():
        np.testing.assert_allclose(again[column], values, rtol=1e-6)
    with pytest.raises(ValueError, match="holds one map, there are 8"):
        sx.write("test.mgh", found, BALL)
