"""Facts about shapes travel as types: names decide nothing, and what moves a vertex drops or maps the shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.embedding.labels import map_metrics
from surfexp.mesh.curved_shapes import Sphere, SphericalCap, Torus
from surfexp.mesh.exact_spectra import lattice_spectrum, rectangle_spectrum
from surfexp.mesh.flat_domain import boundary_angles
from surfexp.mesh.flat_shapes import Disk, FlatTorus, Polygon, Rectangle
from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shapes.counterexamples import named_revolution
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.fibonacci_sphere import fibonacci_sphere
from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.spherical_cap import capped_sphere, spherical_cap
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface, Truth
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_periodic import periodic_operator, periodic_surface
from surfexp.operators.fem import fem
from surfexp.operators.manufactured import manufactured
from surfexp.populations.atrophy import with_atrophy
from surfexp.populations.disguise import disguise
from surfexp.populations.synthetic_subject import synthetic_subject
from surfexp.spectrum.surface_spectrum import elements_of, surface_spectrum

SHAPED = {
    "sphere": icosphere(2, 1.5),
    "fibonacci": fibonacci_sphere(80, radius=0.7),
    "capped": capped_sphere(1.0, 4),
    "cap": spherical_cap(0.8, 5, 2.0),
    "torus": torus(24, 12, 1.2, 0.3, jitter=0.2),
    "disk": disk(5, 2.0),
    "rectangle": rectangle(7, 5, 1.5, 1.0),
    "flat torus": periodic_surface(8, "hexagonal"),
}


@pytest.mark.parametrize("name", SHAPED)
def test_generators_state_their_shape_and_similar_copies_keep_it(name: str) -> None:
    surface = SHAPED[name]
    assert surface.shape is not None and surface.shape.holds(surface.mesh)
    copy = disguise(surface, scale=3.0, seed=4)
    assert type(copy.shape) is type(surface.shape)
    if not isinstance(surface.shape, FlatTorus):
        assert not surface.shape.holds(copy.mesh) and copy.shape.holds(copy.mesh)


@pytest.mark.parametrize("name", SHAPED)
def test_whatever_moves_a_vertex_drops_the_shape(name: str) -> None:
    surface = SHAPED[name]
    assert add_vertex_noise(surface, 0.01).shape is None
    assert add_vertex_noise(surface, 0.0).shape == surface.shape
    assert disguise(surface, bend=0.5).shape is None
    assert disguise(surface, remeshed=True).shape is None
    if surface.mesh.is_closed:
        assert with_atrophy(surface, 0.05).shape is None
    assert synthetic_subject(surface, 0, "right", remeshed=False).shape is None
    if isinstance(surface.shape, FlatTorus):
        return
    moved = TriangleMesh(surface.mesh.vertices * [1.0, 1.0 + 1e-6, 1.0], surface.mesh.faces)
    with pytest.raises(ValueError, match="do not lie on a"):
        replace(surface, mesh=moved)


def test_shapes_are_told_from_others_of_their_kind() -> None:
    sheet = rectangle(7, 5, 1.5, 1.0).mesh
    assert Rectangle(1.0, 1.5).holds(sheet)
    assert not Rectangle(3.0, 0.5).holds(sheet) and not Disk(1.0).holds(sheet)
    sheared = TriangleMesh(sheet.vertices @ np.array([[1.0, 0, 0], [0.2, 1, 0], [0, 0, 1]]), sheet.faces)
    assert not Rectangle(1.5, 1.0).holds(sheared)
    assert Polygon(tuple(boundary_angles(sheared)), 1.5).holds(sheared)
    assert not Sphere(1.0).holds(named_revolution("sphere", 20, 12).mesh)
    assert not SphericalCap(1.0, 0.5).holds(icosphere(2).mesh) and not Torus(1.0, 0.41).holds(torus(20, 10).mesh)


def test_the_name_torus_bends_no_element() -> None:
    """Nodes of a noisy or bent torus, of an implicit one and of a file lie on its facets, or are refused by name."""
    ring = torus(24, 12)
    operator = fem(ring.mesh)
    impostors = [
        add_vertex_noise(ring, 0.02),
        disguise(ring, shuffled=False, rotated=False, bend=1.0),
        genus_surface(1, 1500),
        Surface(ring.mesh, "torus"),
    ]
    for surface in impostors:
        renamed = replace(surface, name="torus")
        flat = elements_of(renamed, fem(renamed.mesh), 2)
        assert flat.area == pytest.approx(renamed.mesh.area, rel=1e-12)
        with pytest.raises(ValueError, match="smooth shape of 'torus' is unknown: choose curved=false, or patches"):
            elements_of(renamed, fem(renamed.mesh), 2, curved=True)
        with pytest.raises(ValueError, match="no sphere about the origin and no torus"):
            manufactured(renamed)
    round_area = elements_of(replace(ring, name="anything"), operator, 2, curved=True).area
    assert round_area == pytest.approx(4 * np.pi**2 * 0.4, rel=1e-3)


def test_nodes_of_a_turned_torus_and_of_a_cap_lie_on_them() -> None:
    ring = disguise(torus(48, 24, 1.0, 0.3), scale=2.0, seed=3)
    elements = elements_of(ring, fem(ring.mesh), 2, curved=True)
    assert elements.area == pytest.approx(4 * np.pi**2 * 4 * 0.3, rel=2e-4)
    cap = disguise(spherical_cap(1.0, 10), seed=3)
    exact = 2 * np.pi * (1 - np.cos(1.0))
    errors = [abs(elements_of(cap, fem(cap.mesh), 2, curved=c).area / exact - 1) for c in (False, True)]
    assert errors[1] < 1e-5 < 2e-3 < errors[0]


@settings(max_examples=15, deadline=None)
@given(st.text(max_size=20), st.sampled_from(["sphere", "disk", "rectangle", "flat torus"]))
def test_renaming_a_surface_changes_no_number(name: str, which: str) -> None:
    surface = SHAPED[which]
    renamed = replace(surface, name=name)
    curved = which in ("sphere", "disk")
    results = []
    for item in (surface, renamed):
        operator = periodic_operator(item) if which == "flat torus" else fem(item.mesh)
        system = surface_spectrum(item, operator, 40, order=2, curved=curved)
        numbers = [*system.values, *system.metrics.values(), *item.shape.spectrum(8, "neumann")]
        copy = disguise(item, seed=1)
        rows = np.random.default_rng(0).integers(0, len(item.mesh.vertices), len(item.mesh.vertices))
        numbers += map_metrics(item, replace(copy, name=name + "?"), rows).values()
        results.append(numbers)
    assert len(results[0]) > 15 and np.array_equal(results[0], results[1])


def test_the_true_origin_counts_on_one_template_alone() -> None:
    body, other = ellipsoid(2), ellipsoid(2, (1.0, 1.2, 0.8))
    copy = disguise(body, seed=1)
    rows = copy.truth.origin
    assert map_metrics(replace(body, name="x"), copy, rows) == {"origin error": 0.0}
    assert map_metrics(replace(other, name=copy.name), copy, rows) == {}
    labelled = replace(body, truth=Truth(labels=np.arange(162) % 5))
    assert np.array_equal(disguise(labelled, seed=2).truth.labels, disguise(labelled, seed=2).truth.origin % 5)
    assert synthetic_subject(body, 1, "left").truth.template == body.mesh.identity
    with pytest.raises(ValueError, match="true labels have shape"):
        replace(body, truth=Truth(labels=np.arange(5)))


def test_spectra_of_lattices_agree_with_products() -> None:
    sides = np.array([[2.0, 0.0], [0.0, 0.5]])
    m, n = np.meshgrid(np.arange(-40, 41), np.arange(-40, 41))
    exact = np.sort((4 * np.pi**2 * ((m / 2.0) ** 2 + (n / 0.5) ** 2)).ravel())[:60]
    assert lattice_spectrum(60, sides) == pytest.approx(exact)
    # even functions along both sides of a torus are those of the free rectangle of half the sides
    assert set(np.round(rectangle_spectrum(10, 1.0, 0.25, "neumann"), 6)) <= set(
        np.round(lattice_spectrum(60, sides), 6)
    )
