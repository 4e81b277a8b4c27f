"""Slivers that leave the eigenvalues of the given triangles in doubt: the same surface is solved on others, and says so."""

import numpy as np
import pytest
from scipy.sparse import block_diag, csr_array, diags_array, eye_array

import surfexp as sx
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.spectrum.components import solve_components
from surfexp.spectrum.eigensolver_error import EigensolverError, SliverError

# so near to an edge that the residual of the constant mode is over the tolerance
THIN = 1e-7


def cut_by_slivers(every=40, thin=THIN):
    """A sphere whose faces are cut, at every so many, into three by a point next to the middle of a side."""
    mesh = sx.shape("icosphere", levels=3).mesh
    vertices, faces = list(mesh.vertices), [tuple(face) for face in mesh.faces.tolist()]
    for number in range(0, len(mesh.faces), every):
        a, b, c = faces[number]
        middle = (mesh.vertices[a] + mesh.vertices[b]) / 2
        new = len(vertices)
        vertices.append(middle + thin * (mesh.vertices[c] - middle))
        faces[number] = (a, b, new)
        faces += [(b, c, new), (c, a, new)]
    return np.array(vertices), np.array(faces)


@pytest.fixture
def scan():
    return cut_by_slivers()


def test_eigenpairs_of_slivers_are_those_of_the_surface(scan):
    whole = sx.eigenpairs(sx.shape("icosphere", levels=3), 9)
    found = sx.eigenpairs(scan, 9)
    assert found.complete and found.residuals.max() < 1e-8
    assert any("Slivers stopped the eigensolver" in note for note in found.notes)
    np.testing.assert_allclose(found.values[1:], whole.values[1:], rtol=1e-3)


def test_sound_triangles_stay_as_they_are():
    found = sx.eigenpairs(cut_by_slivers(thin=1e-3), 9)
    assert found.complete and not any("Slivers stopped" in note for note in found.notes)


def test_every_way_to_pairs_survives_slivers(scan, tmp_path):
    sx.write(tmp_path / "scan.vtp", sx.Surface(TriangleMesh(*scan)))
    table = sx.fingerprint([tmp_path / "scan.vtp"], count=6, repair=False)
    assert not table.refused and table.complete["scan"]
    assert any("Slivers" in note for note in table.repairs["scan"])
    nulls = sx.null_maps(scan, scan[0][:, 2], 9, modes=9)
    assert nulls.certificate["complete"] and any("Slivers" in note for note in nulls.notes)
    assert sx.ShapeDNA(n=4).fit_transform([scan]).shape == (1, 4)
    assert sx.distance(scan, scan, 3).value == pytest.approx(0.0, abs=1e-6)


def test_a_spectrum_goes_on_with_other_triangles_and_counts_alike(scan):
    spectrum = sx.Spectrum(scan)
    between = spectrum.between(1.0, 7.0)
    first = spectrum.first(9)
    assert spectrum.count_below(7.0) == 9 and len(between.values) == 8
    np.testing.assert_allclose(between.values, first.values[1:], rtol=1e-7)
    for found in (between, first):
        assert found.complete and sum("Slivers" in note for note in found.notes) == 1


@pytest.mark.parametrize("kind", [EigensolverError, SliverError])
def test_what_stops_one_component_is_told_apart(kind):
    path = diags_array([np.r_[1.0, np.full(18, 2.0), 1.0], -np.ones(19), -np.ones(19)], offsets=[0, 1, -1])
    both, labels = block_diag([path, path], format="csr"), np.repeat([0, 1], 20)

    def stop(stiffness, mass, count):
        raise kind("pair 0 has residual 1")

    with pytest.raises(kind, match=r"^component 0 of 2 .20 rows.: pair 0 has residual 1") as caught:
        solve_components(csr_array(both), csr_array(eye_array(40)), labels, 4, stop, dense_size=0)
    assert type(caught.value) is kind


def test_a_component_with_slivers_beside_a_sound_one(scan):
    sound = sx.shape("icosphere", levels=4).mesh
    both = np.concatenate([scan[0], sound.vertices + 5.0]), np.concatenate([scan[1], sound.faces + len(scan[0])])
    found = sx.eigenpairs(both, 20)
    assert found.complete and (np.abs(found.values) < 1e-6).sum() == 2


def test_a_tolerance_below_rounding_is_named_and_no_sliver_blamed():
    """Ellipsoid with angles from 35 degrees on: rounding leaves more than 1e-12."""
    body, said = (
        sx.shape("ellipsoid", levels=5),
        r"residual \S+, above tolerance 1e-12, and no .*: take a larger tolerance",
    )
    with pytest.raises(EigensolverError, match=said):
        sx.eigenpairs(body, 150, tolerance=1e-12)
    with pytest.raises(EigensolverError, match=said):
        sx.Spectrum(body, tolerance=1e-12).first(150)
