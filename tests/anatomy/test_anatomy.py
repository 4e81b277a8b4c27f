"""Surfaces of label volumes, bodies with bones, planted atrophy."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.anatomy.label_volume import DONORS, LabelVolume, label_of
from surfexp.anatomy.subcortical import largest_piece, subcortical_surface, surface_of_label
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import validate
from surfexp.populations.articulated import BODIES, articulated_body, carried_body, posed_bones
from surfexp.populations.atrophy import with_atrophy


def ball(radius: float = 12.0, size: int = 40) -> LabelVolume:
    grid = np.stack(np.meshgrid(*[np.arange(size)] * 3, indexing="ij"), axis=-1) - (size - 1) / 2
    labels = np.where(np.linalg.norm(grid, axis=-1) <= radius, 7, 0)
    return LabelVolume(labels, np.diag([0.5, 0.5, 0.5, 1.0]))


@pytest.mark.parametrize("vertices", [0, 1200])
def test_a_ball_of_voxels_becomes_a_sphere(vertices: int) -> None:
    volume = ball()
    volume.labels[20, 20, 20] = 0  # a hole inside is filled
    volume.labels[1:3, 1, 1] = 7  # a crumb outside is dropped
    surface = surface_of_label(volume, 7, 1.3, vertices)
    mesh = surface.mesh
    assert validate(mesh.vertices, mesh.faces).ok and mesh.genus == 0 and mesh.is_closed
    assert vertices in (0, len(mesh.vertices))
    radii = np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1)
    assert radii == pytest.approx(6.0, abs=0.25)
    assert enclosed_volume(mesh) == pytest.approx(4 / 3 * np.pi * (6 - 0.65**2 / 6) ** 3, rel=0.02)
    assert surface.metrics["volume_loss"] == pytest.approx(
        1 - enclosed_volume(mesh) / (0.125 * (volume.labels == 7).sum())
    )
    assert surface.metrics["voxels_dropped"] == pytest.approx(2 / (volume.labels == 7).sum(), rel=0.5)


def test_mirrored_volumes_still_look_outward() -> None:
    volume = ball()
    mirrored = LabelVolume(volume.labels, np.diag([-0.5, 0.5, 0.5, 1.0]))
    assert enclosed_volume(surface_of_label(mirrored, 7, 1.3, 600).mesh) > 0


def test_largest_piece_and_refusals() -> None:
    inside = np.zeros((5, 5, 5), bool)
    inside[0, 0, :2] = inside[3, 3, :] = True
    assert largest_piece(inside).sum() == 5
    with pytest.raises(ValueError, match="carries the label 9"):
        surface_of_label(ball(), 9)
    with pytest.raises(ValueError, match="nothing is left"):
        surface_of_label(ball(1.0), 7, 3.0)
    with pytest.raises(ValueError, match="above 0"):
        surface_of_label(ball(), 7, 0.0)
    with pytest.raises(ValueError, match="choose one of caudate"):
        label_of("brain", "left")
    with pytest.raises(ValueError, match="choose one of 9861"):
        subcortical_surface("1", "caudate", "left")


def test_labels_of_both_sides_differ() -> None:
    pytest.importorskip("nibabel")
    assert label_of("caudate", "left") == 36 and label_of("caudate", "right") == 77
    assert len(DONORS) == 6


def test_a_persons_hippocampus_is_a_sphere_in_topology() -> None:
    surface = subcortical_surface("15697", "hippocampus", "right", vertices=1500)
    assert surface.mesh.genus == 0 and surface.mesh.is_closed and len(surface.mesh.vertices) == 1500
    assert surface.unit == "mm" and 2000 < surface.metrics["volume"] < 8000
    assert 0.0 < surface.metrics["volume_loss"] < 0.3 and surface.mesh.minimum_angle > 20


@pytest.mark.slow
@pytest.mark.parametrize("donor", DONORS)
def test_all_structures_are_spheres(donor: str) -> None:
    for structure in ("caudate", "putamen", "hippocampus", "thalamus", "amygdala"):
        for hemisphere in ("left", "right"):
            mesh = subcortical_surface(donor, structure, hemisphere).mesh
            assert mesh.genus == 0 and mesh.is_closed and mesh.component_count == 1


@pytest.mark.parametrize("body", BODIES)
def test_poses_keep_bones_and_topology(body: str) -> None:
    rest, posed = posed_bones(body, 0, 0.0), posed_bones(body, 3)
    lengths = [np.linalg.norm(bones[:, 3:6] - bones[:, :3], axis=1) for bones in (rest, posed)]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-12)
    assert np.abs(posed[:, 3:6] - rest[:, 3:6]).max() > 0.05
    surface = articulated_body(body, 3, vertices=900)
    assert surface.mesh.genus == 0 and surface.mesh.is_closed and surface.mesh.component_count == 1
    assert abs(surface.metrics["area_change"]) < 0.025
    again = articulated_body(body, 3, vertices=900)
    assert np.array_equal(again.mesh.vertices, surface.mesh.vertices)


def test_unfit_bodies_are_refused() -> None:
    with pytest.raises(ValueError, match="choose one of biped"):
        articulated_body("tree")
    with pytest.raises(ValueError, match="400 are needed"):
        articulated_body("worm", vertices=100)


def test_planted_atrophy_takes_volume_from_one_end() -> None:
    ball_mesh = icosphere(4).mesh
    shape = Surface(TriangleMesh(ball_mesh.vertices * [3.0, 1.0, 1.0], ball_mesh.faces), "bean", "mm")
    losses = [with_atrophy(shape, depth).metrics["tissue_lost"] for depth in (0.0, 0.1, 0.2)]
    assert losses[0] == pytest.approx(0.0, abs=1e-12) and 0.01 < losses[1] < losses[2] < 0.3
    moved = np.linalg.norm(with_atrophy(shape, 0.2).mesh.vertices - shape.mesh.vertices, axis=1)
    x = shape.mesh.vertices[:, 0]
    assert moved[np.abs(x) > 2.5].max() == pytest.approx(0.2, rel=0.05)
    assert min(moved[x > 2.5].max(), moved[x < -2.5].max()) < 1e-3
    with pytest.raises(ValueError, match="must not be negative"):
        with_atrophy(shape, -1.0)


def test_a_skin_carried_along_keeps_its_vertices_and_most_lengths() -> None:
    rest = articulated_body("biped", 0, vertices=900).mesh
    assert carried_body("biped", 1, 0.0, 900).mesh.vertices == pytest.approx(rest.vertices, abs=1e-12)
    posed = carried_body("biped", 1, 1.0, 900).mesh
    assert (posed.faces == rest.faces).all()
    assert np.linalg.norm(posed.vertices - rest.vertices, axis=1).max() > 0.2
    lengths = [np.linalg.norm(np.diff(mesh.vertices[rest.edges], axis=1), axis=2) for mesh in (rest, posed)]
    assert np.median(np.abs(lengths[1] / lengths[0] - 1.0)) < 0.02


@pytest.mark.parametrize("body", ["biped", "worm"])
def test_joints_turn_by_no_more_than_their_freedom_and_bones_keep_their_length(body: str) -> None:
    freedom, rest = np.radians([bone[8] for bone in BODIES[body]]), posed_bones(body, 0, 0.0)
    parents = [int(bone[0]) for bone in BODIES[body]]
    largest = np.zeros(len(parents))
    for pose in range(1, 30):
        cones = posed_bones(body, pose, 1.0)
        lengths = np.linalg.norm(cones[:, 3:6] - cones[:, :3], axis=1)
        assert lengths == pytest.approx([bone[5] for bone in BODIES[body]])
        directions = [(part[:, 3:6] - part[:, :3]) / lengths[:, None] for part in (rest, cones)]
        for k, parent in enumerate(parents):
            if parent < 0:
                largest[k] = max(largest[k], np.arccos(np.clip(directions[0][k] @ directions[1][k], -1.0, 1.0)))
                continue
            # a joint changes the angle between two bones by no more than it turns
            angles = [np.arccos(np.clip(part[k] @ part[parent], -1.0, 1.0)) for part in directions]
            largest[k] = max(largest[k], abs(angles[1] - angles[0]))
    assert (largest <= freedom + 1e-9).all() and (largest > 0.3 * freedom).any()
