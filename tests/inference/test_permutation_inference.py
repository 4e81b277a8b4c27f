"""Null distributions against enumeration, and the level of the tests on data without an effect."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
from reference import components, enhanced_by_definition
from scipy.stats import binom, ttest_1samp, ttest_ind

from surfexp.inference.corrections import family_wise
from surfexp.inference.linear_model import contrast_model
from surfexp.inference.permutation_inference import NullDistributions, Statistics, null_distributions
from surfexp.inference.rearrangements import Rearrangements, permutations, sign_flips
from surfexp.inference.vertex_graph import vertex_graph
from surfexp.mesh.shapes.icosphere import icosphere

BALL = icosphere(levels=1).mesh
STATISTICS = Statistics(vertex_graph(BALL), 2.0)
DATA = np.random.default_rng(3).standard_normal((7, len(BALL.vertices))) + np.maximum(BALL.vertices[:, 2], 0.0)


def compare_with(t_maps: np.ndarray, observed: np.ndarray, found: NullDistributions) -> None:
    """All four statistics of all maps by their definitions."""
    areas = BALL.vertex_areas
    raised = np.array([enhanced_by_definition(t, BALL.edges, areas, 1.0, 2.0) for t in t_maps])
    extents, masses = [], []
    for t in t_maps:
        extent, mass = [0.0], [0.0]
        for sign in (1.0, -1.0):
            labels = components(BALL.edges, sign * t >= 2.0)
            extent += [areas[labels == one].sum() for one in np.unique(labels[labels >= 0])]
            mass += [(areas * np.abs(t))[labels == one].sum() for one in np.unique(labels[labels >= 0])]
        extents.append(max(extent))
        masses.append(max(mass))
    wanted = {"t": np.abs(t_maps).max(axis=1), "tfce": np.abs(raised).max(axis=1), "extent": extents, "mass": masses}
    for name, largest in wanted.items():
        np.testing.assert_allclose(np.sort(found.largest[name]), np.sort(largest), rtol=1e-9)
    np.testing.assert_allclose(found.t, observed, rtol=1e-9)
    np.testing.assert_allclose(found.p_t, (np.abs(t_maps) >= np.abs(observed) * (1 - 1e-9)).mean(axis=0))
    exact = (np.abs(t_maps).max(axis=1)[:, None] >= np.abs(observed) * (1 - 1e-9)).mean(axis=0)
    np.testing.assert_allclose(family_wise(np.abs(found.t), found.largest["t"]), exact)
    own = enhanced_by_definition(observed, BALL.edges, areas, 1.0, 2.0)
    np.testing.assert_allclose(found.p_tfce, (np.abs(raised) >= np.abs(own) * (1 - 1e-9)).mean(axis=0))


def test_all_sign_flips_are_the_exact_test() -> None:
    found = null_distributions(
        contrast_model(DATA, np.ones((7, 1)), np.ones(1)),
        sign_flips(np.arange(7), 128, np.random.default_rng(0)),
        STATISTICS,
    )
    t_maps = np.array([ttest_1samp(DATA * np.array(s)[:, None], 0.0).statistic for s in product((1, -1), repeat=7)])
    compare_with(t_maps, ttest_1samp(DATA, 0.0).statistic, found)


def test_all_splits_of_two_groups_are_the_exact_test() -> None:
    groups = np.array([1, 1, 0, 0, 0, 1, 0.0])
    design = np.column_stack([groups, 1.0 - groups])
    chosen = permutations(np.arange(7), np.zeros(7, dtype=int), design, 35, np.random.default_rng(0))
    found = null_distributions(contrast_model(DATA, design, np.array([1.0, -1.0])), chosen, STATISTICS)
    t_maps = []
    for inside in combinations(range(7), 3):
        others = [k for k in range(7) if k not in inside]
        t_maps.append(ttest_ind(DATA[list(inside)], DATA[others]).statistic)
    compare_with(np.array(t_maps), ttest_ind(DATA[groups == 1], DATA[groups == 0]).statistic, found)


def test_the_number_of_threads_changes_nothing() -> None:
    model = contrast_model(DATA, np.ones((7, 1)), np.ones(1))
    chosen = sign_flips(np.arange(7), 100, np.random.default_rng(0))
    seen: list[int] = []
    one = null_distributions(model, chosen, STATISTICS, progress=lambda done, rest: seen.append(done))
    two = null_distributions(model, chosen, STATISTICS, threads=2)
    assert seen == [32, 64, 96, 100]
    assert all((one.largest[name] == two.largest[name]).all() for name in one.largest)
    assert (one.p_t == two.p_t).all() and (one.p_tfce == two.p_tfce).all()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["one sample", "two groups", "covariate"])
def test_the_level_is_kept_on_smooth_noise(kind: str) -> None:
    """1,000 data sets of 12 smooth maps: rejections at 5 % in the central 99.9 % of the binomial distribution."""
    ball = icosphere(levels=3).mesh
    statistics = Statistics(vertex_graph(ball), 2.5)
    random = np.random.default_rng(7)
    age = random.standard_normal(12)
    designs = {
        "one sample": (np.ones((12, 1)), np.ones(1)),
        "two groups": (np.repeat(np.eye(2), 6, axis=0), np.array([1.0, -1.0])),
        "covariate": (np.column_stack([np.ones(12), age, age + random.standard_normal(12)]), np.array([0.0, 0.0, 1.0])),
    }
    design, contrast = designs[kind]
    single, count = np.arange(12), 199 + 1
    rejected = dict.fromkeys(("t", "tfce", "extent", "mass"), 0)
    for _ in range(1000):
        waves = random.standard_normal((3, 40)) * 4.0
        phases = random.uniform(0.0, 2.0 * np.pi, 40)
        data = random.standard_normal((12, 40)) @ np.sin(ball.vertices @ waves + phases).T
        model = contrast_model(data, design, contrast)
        chosen: Rearrangements = (
            permutations(single, np.zeros(12, dtype=int), design, count, random)
            if model.has_mean
            else sign_flips(single, count, random)
        )
        found = null_distributions(model, chosen, statistics)
        # the first rearrangement is the data as they are
        for name, largest in found.largest.items():
            rejected[name] += bool(family_wise(largest[:1], largest)[0] <= 0.05)
    low, high = binom.interval(0.999, 1000, 0.05)
    assert all(low <= rejected[name] <= high for name in ("t", "tfce")), rejected
    # where no vertex reaches the threshold there is no cluster, so that these can reject less often
    assert all(rejected[name] <= high for name in ("extent", "mass")), rejected
