"""Two-phase segmentation that can be trusted: no unit, no worse than what is trivial, phases by their means, true reasons."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.operators.vertex_averaged import vertex_averaged
from surfexp.variational.image import Image
from surfexp.variational.mean_updates import MeanUpdates
from surfexp.variational.models.chan_vese import ChanVese
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.models.multiphase import MultiphaseSegmentation
from surfexp.variational.published.split_bregman import published_split_bregman
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual

FACTORS = st.floats(-3.0, 3.0).map(lambda exponent: 10.0**exponent)
SOLVE = partial(primal_dual, tolerance=1e-3)


def heavy_tailed(surface: Surface, seed: int = 0) -> Image:
    """Waves cubed, with noise: like the curvature of folds, most of it near 0 and some of it far away."""
    rng = np.random.default_rng(seed)
    waves = np.sin(5 * rng.normal(size=3) @ surface.mesh.vertices.T) + np.cos(
        4 * rng.normal(size=3) @ surface.mesh.vertices.T
    )
    return Image(waves**3 + 0.3 * rng.normal(size=len(surface.mesh.vertices)))


def energy(operator: SurfaceOperator, slope: np.ndarray, values: np.ndarray) -> float:
    return total_variation(operator, values) + float(operator.mass @ (slope * values))


@pytest.mark.slow
@settings(deadline=None, max_examples=3)
@given(size=FACTORS, unit=FACTORS)
def test_scales_change_no_label(size: float, unit: float) -> None:
    """Size of the surface and unit of the image, for the three models; every number of the result scales as it must."""
    surface = torus(36, 18, jitter=0.15, seed=2)
    image = heavy_tailed(surface)
    larger = TriangleMesh(size * surface.mesh.vertices, surface.mesh.faces)
    scaled = replace(image, values=unit * image.values)
    solve = lambda model, mesh, shown: model.run(shown, fem(mesh), SOLVE)  # noqa: E731
    for model in (ConvexChanVese(), MultiphaseSegmentation(2), ChanVese(iteration_limit=20)):
        first, second = solve(model, surface.mesh, image), solve(model, larger, scaled)
        assert (first.segmentation == second.segmentation).all()
        assert first.reason == second.reason and first.iterations == second.iterations
        assert second.energy == pytest.approx(size * first.energy, rel=1e-6)
        assert second.metrics["c1"] == pytest.approx(unit * first.metrics["c1"], rel=1e-9)


@given(size=FACTORS, unit=FACTORS)
def test_the_weight_scales_as_one_over_a_length_and_two_units(size: float, unit: float) -> None:
    """The perimeter over area times variance."""
    surface = torus(12, 6)
    image = heavy_tailed(surface)
    weight = ConvexChanVese().weight(image, fem(surface.mesh))
    larger = fem(TriangleMesh(size * surface.mesh.vertices, surface.mesh.faces))
    scaled = ConvexChanVese().weight(replace(image, values=unit * image.values), larger)
    assert scaled * size * unit**2 == pytest.approx(weight, rel=1e-9)


def test_refinement_moves_the_boundary_by_less_than_an_edge() -> None:
    """The same function on finer spheres: the share converges, and so does the segmentation."""
    shares, widths = [], []
    for levels in (4, 5):
        surface = icosphere(levels)
        x, y, z = surface.mesh.vertices.T
        image = Image(np.sin(4 * x) * np.cos(3 * y) + 0.5 * z)
        solution = ConvexChanVese().run(image, fem(surface.mesh), SOLVE)
        shares.append(solution.segmentation)
        widths.append(solution.metrics["brighter_share"])
    coarse, fine = shares
    assert (fine[: len(coarse)] != coarse).mean() < 0.02 and widths[0] == pytest.approx(widths[1], abs=0.01)


@settings(deadline=None, max_examples=6)
@given(
    seed=st.integers(0, 10**6), smoothness=st.sampled_from([0.1, 0.3, 1.0, 3.0, 10.0]), limit=st.sampled_from([3, 1000])
)
def test_no_result_is_worse_than_a_trivial_one(seed: int, smoothness: float, limit: int) -> None:
    """Whatever the weight, also from a solver that was stopped early; every energy written out again."""
    surface = torus(24, 12, jitter=0.2, seed=1)
    operator, image = fem(surface.mesh), heavy_tailed(torus(24, 12, jitter=0.2, seed=1), seed)
    model = ConvexChanVese(smoothness, updates=5)
    solution = model.run(image, operator, partial(primal_dual, tolerance=1e-4, iteration_limit=limit))
    metrics = solution.metrics
    means = metrics["c1"], metrics["c2"]
    slope = model.fidelity(image, operator, means)[0].slope
    trivial = [energy(operator, slope, (image.values > t).astype(float)) for t in (-np.inf, *image.values)]
    size = 1e-9 * float(operator.mass @ np.abs(slope))
    assert metrics["trivial_energy"] == pytest.approx(min(trivial), abs=size)
    assert solution.energy == pytest.approx(energy(operator, slope, solution.values), abs=size)
    labelling = energy(operator, slope, solution.segmentation)
    assert metrics["labelling_energy"] == pytest.approx(labelling, abs=size)
    assert solution.lower_bound <= solution.energy + size
    assert solution.energy <= min(trivial) + size and labelling <= min(trivial) + size
    assert solution.relative_gap <= 1.0 + 1e-6
    assert metrics["gap"] == pytest.approx(solution.energy - solution.lower_bound, abs=size)
    region = solution.segmentation > 0.5
    if region.any() and not region.all():
        assert np.average(image.values[region], weights=operator.mass[region]) > means[0] / 2 + means[1] / 2
        assert np.average(image.values[~region], weights=operator.mass[~region]) < means[0] / 2 + means[1] / 2


def test_the_gap_is_a_share_of_the_spread_from_the_best_trivial_labelling(surface: Surface, image: Image) -> None:
    solution = ConvexChanVese().run(image, fem(surface.mesh), SOLVE)
    metrics = solution.metrics
    spread = metrics["trivial_energy"] - metrics["lower_bound"]
    assert metrics["relative_gap"] == pytest.approx(metrics["gap"] / spread, rel=1e-9)
    left = metrics["labelling_energy"] - metrics["lower_bound"]
    assert metrics["labelling_gap"] * spread == pytest.approx(left, abs=1e-9 * abs(metrics["lower_bound"]))


def test_a_solver_as_published_is_replaced_by_what_is_better_and_it_is_said(surface: Surface, image: Image) -> None:
    operator = vertex_averaged(surface.mesh)
    method = partial(published_split_bregman, inner="direct", tolerance=1e-3, iteration_limit=20)
    solution = ConvexChanVese(smoothness=1.0).run(image, operator, method)
    assert solution.metrics["solver_gap"] >= solution.relative_gap
    assert solution.energy <= solution.metrics["trivial_energy"]
    if solution.metrics["solver_gap"] > solution.relative_gap:
        assert any("exceeds that of" in note for note in solution.notes)


@pytest.mark.parametrize("inverted", [False, True])
def test_region_1_is_the_brighter_one_from_either_start(surface: Surface, image: Image, inverted: bool) -> None:
    start = image.labels["bright"] != inverted
    for model in (ConvexChanVese(initial=start), ChanVese(initial=start)):
        solution = model.run(image, fem(surface.mesh), SOLVE)
        assert solution.metrics["c1"] > 200 > 50 > solution.metrics["c2"]
        assert solution.metrics["dice bright"] > 0.97


def test_a_curve_is_at_rest_after_so_many_steps_without_a_change() -> None:
    mesh = icosphere(3).mesh
    operator, height = fem(mesh), mesh.vertices[:, 2]
    image = Image(np.where(height > 0.1, 200.0, 20.0) + np.random.default_rng(0).normal(size=len(height)))

    def descended(limit: int, rest: int) -> Solution:
        return ChanVese(initial=height > 0.6, tolerance=-1.0, rest=rest, iteration_limit=limit).run(image, operator)

    found = descended(1000, 30)
    assert found.converged and found.reason == "no vertex changed its side in 30 steps"
    last, before = (descended(found.iterations - steps, 1000).segmentation for steps in (30, 31))
    assert (last == found.segmentation).all() and (before != found.segmentation).any()


def test_several_regions_are_in_the_order_of_their_means(surface: Surface, image: Image) -> None:
    solution = MultiphaseSegmentation(4).run(image, fem(surface.mesh), SOLVE)
    means = [solution.metrics[f"c{j}"] for j in range(1, 5)]
    assert means == sorted(means)
    assert solution.relative_gap <= 1.0


def outcome(updates: MeanUpdates, sequence: list[float], converged: bool = True) -> Solution:
    for mean in sequence:
        if not updates.again(np.array([mean, -1.0])):
            break
    return updates.judge(
        Solution(np.zeros(3), 0.0, converged=converged, reason="gap below tolerance" if converged else "limit")
    )


def test_the_reason_is_the_true_one() -> None:
    settled = outcome(MeanUpdates(1.0, 20), [3.0, 2.0, 1.00001, 1.0])
    assert settled.converged and settled.reason == "gap below tolerance" and settled.metrics["updates"] == 3
    cycle = outcome(MeanUpdates(1.0, 20), [5.0, 3.0, 2.0, 1.0, 3.0])
    assert not cycle.converged and cycle.reason == "the means repeat with period 3 after 4 updates"
    moving = outcome(MeanUpdates(2.0, 3), [5.0, 3.0, 2.0, 1.0])
    assert not moving.converged and moving.reason == "the means still change after 3 updates, by 5.0e-01 of the range"
    both = outcome(MeanUpdates(2.0, 3), [5.0, 3.0, 2.0, 1.0], converged=False)
    assert "still change" in both.reason and both.reason.endswith("in the last convex problem: limit")
    inner = outcome(MeanUpdates(2.0, 3), [1.0, 1.0], converged=False)
    assert not inner.converged and inner.reason == "limit"
