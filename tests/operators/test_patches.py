"""Nodes on patches through the vertices of a bare mesh, and elements on flat tori."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_lagrange import lagrange_nodes
from surfexp.operators.elements_nodes import flat_positions, number_nodes
from surfexp.operators.elements_patches import patch_normals, patch_positions
from surfexp.operators.elements_surface import assemble_elements
from surfexp.operators.fem import fem
from surfexp.spectrum.surface_spectrum import surface_spectrum


def squeezed(levels: int) -> TriangleMesh:
    ball = icosphere(levels).mesh
    return TriangleMesh(ball.vertices * [1.4, 1.0, 0.7], ball.faces)


def test_normals_of_a_sphere_are_exact() -> None:
    mesh = icosphere(2).mesh
    moved = mesh.vertices + np.random.default_rng(0).normal(size=mesh.vertices.shape) * 0.05
    uneven = TriangleMesh(moved / np.linalg.norm(moved, axis=1, keepdims=True), mesh.faces)
    assert np.abs(patch_normals(uneven) - uneven.vertices).max() < 1e-12
    assert np.abs(uneven.vertex_normals - uneven.vertices).max() > 1e-3


@pytest.mark.parametrize("order", [1, 2, 3])
def test_faces_agree_on_common_sides_and_flat_meshes_stay_flat(order: int) -> None:
    mesh = squeezed(2)
    positions = patch_positions(mesh, order)
    nodes = number_nodes(mesh.faces, len(mesh.vertices), order)
    shared = np.zeros((nodes.count, 3))
    shared[nodes.connectivity] = positions
    assert np.abs(shared[nodes.connectivity] - positions).max() < 1e-12
    assert np.array_equal(positions[:, :3], mesh.vertices[mesh.faces])
    flat = rectangle(5, 4).mesh
    assert patch_positions(flat, order) == pytest.approx(flat_positions(flat.vertices[flat.faces], order), abs=1e-14)


def test_a_patch_has_the_side_curves_of_hermite() -> None:
    """At thirds of a side the cubic through both ends with the projected side as tangent, written out anew."""
    mesh = squeezed(1)
    normals = patch_normals(mesh)
    positions = patch_positions(mesh, 3)
    nodes = lagrange_nodes(3)
    for place in range(3, 9):
        (start, end), t = np.argsort(-nodes[place], kind="stable")[:2], float(np.sort(nodes[place])[1])
        p, q = mesh.vertices[mesh.faces[:, start]], mesh.vertices[mesh.faces[:, end]]
        out, into = (
            (q - p) - ((q - p) * n).sum(axis=1, keepdims=True) * n
            for n in (normals[mesh.faces[:, start]], normals[mesh.faces[:, end]])
        )
        blend = (2 * t**3 - 3 * t**2 + 1) * p + (t**3 - 2 * t**2 + t) * out
        blend += (-2 * t**3 + 3 * t**2) * q + (t**3 - t**2) * into
        assert positions[:, place] == pytest.approx(blend, abs=1e-13)


def test_area_of_an_ellipsoid_converges_faster_than_on_facets() -> None:
    from scipy.integrate import dblquad

    a, b, c = 1.4, 1.0, 0.7

    def element(v: float, u: float) -> float:
        s = np.sin(v)
        return float(
            s * np.sqrt((b * c * s * np.cos(u)) ** 2 + (a * c * s * np.sin(u)) ** 2 + (a * b * np.cos(v)) ** 2)
        )

    exact = dblquad(element, 0, 2 * np.pi, 0, np.pi)[0]
    errors = {"flat": [], "patches": []}
    for levels in (2, 3):
        mesh = squeezed(levels)
        nodes = number_nodes(mesh.faces, len(mesh.vertices), 2)
        for name, positions in (
            ("flat", flat_positions(mesh.vertices[mesh.faces], 2)),
            ("patches", patch_positions(mesh, 2)),
        ):
            errors[name].append(abs(assemble_elements(nodes, positions).area / exact - 1.0))
    assert np.log2(errors["flat"][0] / errors["flat"][1]) == pytest.approx(2.0, abs=0.2)
    assert np.log2(errors["patches"][0] / errors["patches"][1]) > 3.0
    assert errors["patches"][1] < 0.05 * errors["flat"][1]


def test_unfit_meshes_are_refused() -> None:
    ball = icosphere(1)
    with pytest.raises(ValueError, match="choose one"):
        surface_spectrum(ball, fem(ball.mesh), 5, order=2, curved=True, patches=True)
    folded = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 1]]))
    with pytest.raises(ValueError, match="has no normal"):
        patch_normals(folded)
