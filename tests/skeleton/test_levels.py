"""Choices of levels, lengths and the parametrisation by level sets."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.skeleton.contour_geometry import contour_lengths
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.level_selection import area_below, choose_levels
from surfexp.skeleton.polyline import trunk
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import chain_order
from surfexp.skeleton.skeleton_length import skeleton_lengths

FLAT = rectangle(121, 25, 5.0, 1.0).mesh
COSINE = -np.cos(np.pi * FLAT.vertices[:, 0] / 5.0)


@pytest.mark.parametrize("levels", [[], [1.0, 1.0], [2.0, 1.0], [0.0, np.nan], [np.inf]])
def test_levels_increase_and_are_numbers(levels: list[float]) -> None:
    with pytest.raises(ValueError, match=f"{len(levels)} levels given, they must be finite and increase"):
        level_contours(FLAT, COSINE, np.array(levels))


def test_uniform_levels_are_short_by_the_share_of_the_text():
    for count in (10, 50):
        skeleton = reeb_graph(FLAT, COSINE, choose_levels(FLAT, COSINE, count, "uniform"))
        lengths = skeleton_lengths(FLAT, COSINE, skeleton)
        kept = 1.0 - 2.0 / np.pi * np.arccos(1.0 - 2.0 / (count + 1))
        assert lengths["polyline_length"] / 5.0 == pytest.approx(kept, abs=4e-3)
        assert lengths["mean_distance_length"] == pytest.approx(5.0, rel=2e-3)


def test_levels_at_equal_distances_and_equal_areas_undo_the_eigenmap():
    for choice in ("arc_length", "area_quantile"):
        levels = choose_levels(FLAT, COSINE, 25, choice)
        x = 5.0 * np.arccos(-levels) / np.pi
        assert np.abs(x - 5.0 * (np.arange(25) + 0.5) / 25).max() < 0.03


def test_area_below_agrees_with_the_levels_of_a_plane():
    levels = np.linspace(0.3, 4.7, 9)
    assert np.allclose(area_below(FLAT, FLAT.vertices[:, 0], levels), levels, atol=1e-12)
    assert np.allclose(area_below(FLAT, COSINE, np.array([-2.0, 2.0])), [0.0, 5.0])


@pytest.mark.parametrize("seed", range(5))
def test_area_below_is_the_divided_difference_of_squares(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = rng.standard_normal(len(FLAT.vertices))
    levels = np.unique(np.r_[np.linspace(-4.0, 4.0, 30), rng.choice(values, 20)])
    corners = values[FLAT.faces]
    shares = np.zeros((len(levels), len(corners)))
    for i, (j, k) in enumerate([(1, 2), (2, 0), (0, 1)]):
        apart = (corners[:, j] - corners[:, i]) * (corners[:, k] - corners[:, i])
        shares += np.maximum(levels[:, None] - corners[:, i], 0.0) ** 2 / apart
    assert area_below(FLAT, values, levels) == pytest.approx(shares @ FLAT.areas, abs=1e-7)


@pytest.mark.parametrize("seed", range(5))
def test_areas_on_both_sides_and_of_plateaus_are_the_whole(seed: int) -> None:
    values = np.random.default_rng(seed).integers(0, 4, len(FLAT.vertices)) / 2.0
    levels = np.linspace(-0.5, 2.0, 11)
    corners = values[FLAT.faces]
    plateau = [FLAT.areas[(corners == level).all(axis=1)].sum() for level in levels]
    above = area_below(FLAT, -values, -levels[::-1])[::-1]
    assert area_below(FLAT, values, levels) + above + plateau == pytest.approx(FLAT.area, rel=1e-13)


def test_a_chain_is_followed_whatever_the_numbers_of_its_nodes() -> None:
    chain = reeb_graph(FLAT, FLAT.vertices[:, 0], np.linspace(0.5, 4.5, 5))
    count = len(chain.values)
    for shift in range(count):
        number = (np.arange(count) + shift) % count
        old = np.argsort(number)
        moved = replace(chain, arcs=number[chain.arcs], values=chain.values[old], positions=chain.positions[old])
        assert np.array_equal(moved.values[chain_order(moved)], np.sort(chain.values))


def test_the_trunk_of_a_graph_with_a_loop_goes_from_lowest_to_highest() -> None:
    ring = torus(40, 20)
    graph = reeb_graph(ring.mesh, ring.mesh.vertices[:, 0], np.linspace(-1.27, 1.27, 12))
    nodes = trunk(graph)
    assert graph.metrics["b1"] == 1 and graph.values[nodes[0]] == graph.values.min()
    assert graph.values[nodes[-1]] == graph.values.max()
    joined = {tuple(sorted(arc)) for arc in graph.arcs.tolist()}
    assert all(tuple(sorted(step)) in joined for step in pairwise(nodes.tolist()))
    assert len(set(nodes.tolist())) == len(nodes) < len(graph.values)


def test_critical_levels_separate_all_critical_values():
    mesh = rectangle(61, 61, 2.0, 2.0).mesh
    x, y = mesh.vertices[:, :2].T
    values = np.sin(3 * x + 0.3) * np.cos(4 * y) + 0.5 * x + 0.3 * x * y
    critical = np.unique(exact_reeb_graph(mesh, values).values)
    levels = choose_levels(mesh, values, 40, "critical")
    assert len(levels) == 40
    wide = np.flatnonzero(np.diff(critical) > 0.05 * np.ptp(values))
    assert all(((levels > critical[i]) & (levels < critical[i + 1])).any() for i in wide) and len(wide) >= 3


def test_unfit_choices_are_refused():
    with pytest.raises(ValueError, match="at least 1"):
        choose_levels(FLAT, COSINE, 0, "arc_length")
    with pytest.raises(ValueError, match="uniform, area_quantile"):
        choose_levels(FLAT, COSINE, 5, "random")
    rough = np.random.default_rng(0).normal(size=len(COSINE))
    assert len(choose_levels(FLAT, rough, 30, "critical")) == 30


def test_contours_that_shrink_to_a_vertex_have_no_length():
    contours = level_contours(FLAT, FLAT.vertices[:, 0] + 2.0 * FLAT.vertices[:, 1], np.array([7.0]))
    assert contour_lengths(contours, FLAT.vertices) == pytest.approx([0.0], abs=1e-9)


def test_a_flat_feature_gives_fewer_levels_and_says_so():
    flat = np.clip(FLAT.vertices[:, 0], 1.0, 2.0)
    load_all(Path("/nonexistent"))
    method = registry.plugin("skeleton", "reeb_graph")
    found = method({"levels": "area_quantile"}, surface=Surface(FLAT), feature=Feature(flat))
    assert found.is_chain and len(found.levels) < 50
    assert f"{len(found.levels)} of 50 levels" in found.notes[0]
    whole = method({}, surface=Surface(FLAT), feature=Feature(COSINE))
    assert len(whole.levels) == 50 and whole.notes == ()
