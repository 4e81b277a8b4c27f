"""Modes of one surface brought into correspondence with those of another: signs, rotations in blocks, what is cut."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

import surfexp as sx
from surfexp.mesh.triangle_mesh import TriangleMesh

BODY = sx.shape("ellipsoid", levels=3)
SPHERE = sx.shape("icosphere", levels=3)
TURN = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]


def renumbered(surface: sx.Surface, scale: float) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Vertices and faces of a copy turned, scaled and renumbered, and the old number of each of its vertices."""
    order = np.random.default_rng(1).permutation(len(surface.mesh.vertices))
    number = np.argsort(order)
    turn = TURN * np.sign(np.linalg.det(TURN))
    return (scale * surface.mesh.vertices[order] @ turn.T, number[surface.mesh.faces]), order


def test_modes_of_a_copy_come_back_mode_by_mode() -> None:
    copy, order = renumbered(BODY, 7.0)
    found = sx.align(BODY, copy, 6)
    assert found.optimal and found.value < 1e-6
    assert found.notes == (
        "At least 7 other choices of signs give the same distance: a surface has a symmetry, "
        "and nothing intrinsic tells which map is right.",
    )  # an ellipsoid has eight symmetries
    assert np.allclose(np.abs(found.basis), np.eye(6), atol=1e-6)
    own = sx.eigenpairs(BODY, 7).vectors[:, 1:]
    signs = np.sign((own[order] * found.vectors).sum(axis=0))
    scale = np.linalg.norm(own) / np.linalg.norm(found.vectors)
    assert abs(signs).all() and np.allclose(own[order], scale * found.vectors * signs, atol=1e-5 * np.abs(own).max())
    # one sign for all modes is free where the body is its own mirror image; relative signs are those of the source
    again = sx.align(BODY, BODY, 6)
    assert np.allclose(again.basis, np.diag(np.diag(again.basis)), atol=1e-6)


def test_one_mode_has_one_sign() -> None:
    found = sx.align(BODY, renumbered(BODY, 2.0)[0], 1)
    assert found.optimal and np.abs(found.basis) == pytest.approx(np.ones((1, 1)), abs=1e-6)


def bent(mirror: bool) -> sx.Surface:
    """A body that is its own mirror image in z, or in nothing."""
    x, y, z = BODY.mesh.vertices.T
    vertices = np.stack(
        [x + 0.4 * y**2 + (0.0 if mirror else 0.3 * y * z), y + 0.3 * z**2, z * (1.0 + 0.3 * x)], axis=1
    )
    return sx.Surface(TriangleMesh(vertices, BODY.mesh.faces), "bent")


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_a_mirror_image_is_said_and_only_that(scale: float) -> None:
    for mirror in (True, False):
        body = bent(mirror)
        copy, order = renumbered(body, scale)
        found = sx.distance(body, copy, n=8)
        assert found.optimal and found.value < 1e-6
        if mirror:
            assert found.notes[0].startswith("Another choice of signs gives the same distance")
        else:
            assert found.notes == () and (found.correspondence == order).all()


def test_unlike_bodies_without_symmetry_have_no_such_note() -> None:
    body = bent(mirror=False)
    x, y, z = body.mesh.vertices.T
    other = sx.Surface(
        TriangleMesh(np.stack([x, y * (1.2 + 0.2 * x), z + 0.1 * x * y], axis=1), body.mesh.faces), "other"
    )
    found = sx.distance(body, other, n=8)
    assert found.value > 1e-3 and found.notes == ()
    assert sx.distance(body, BODY, n=8).notes  # three mirrors of one of the two


@pytest.mark.parametrize(("count", "cut"), [(3, False), (5, True), (8, False), (12, True)])
def test_a_cut_block_is_said_with_the_way_out(count: int, cut: bool) -> None:
    found = sx.align(SPHERE, SPHERE, count)  # modes 1 to 3, 4 to 8 and 9 to 15 have one eigenvalue each
    said = [note for note in found.notes if "the last block is cut" in note]
    assert len(said) == cut
    if cut:
        assert f"{3 if count < 8 else 8} modes end between two" in said[0]


def test_blocks_are_rotated_as_a_whole() -> None:
    copy, _ = renumbered(SPHERE, 2.0)
    found = sx.align(SPHERE, copy, 8)
    assert found.blocks == ((1, 3), (4, 8))
    assert np.allclose(found.basis.T @ found.basis, np.eye(8), atol=1e-9)
    assert np.abs(found.basis[:3, 3:]).max() == 0.0 and np.abs(found.basis[3:, :3]).max() == 0.0


def test_aligned_modes_lie_on_those_of_the_source_where_clusters_are_turned() -> None:
    """Clusters of 3 and 5 equal values, in which a solver's basis is an accident: turned back, the two clouds are one."""
    copy, _ = renumbered(SPHERE, 1.0)
    found = sx.align(SPHERE, copy, 8)
    # the call by which the modes are found there: one more than is aligned
    own = sx.eigenpairs(SPHERE, 10)
    assert np.abs(found.basis - found.basis.T).max() > 0.1
    weights = np.sqrt(SPHERE.mesh.area) / (own.values[1:9] * SPHERE.mesh.area)
    ours, theirs = own.vectors[:, 1:9] * weights, found.vectors * weights
    apart = cKDTree(ours).query(theirs)[0].mean()
    turned = cKDTree(ours).query(theirs @ found.basis.T @ found.basis.T)[0].mean()
    assert apart < 1.5 * found.value + 1e-6 and turned > 3.0 * apart
