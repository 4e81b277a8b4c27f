"""Every defect planted, found, named and mended."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.face_repair import flip_zero_area_faces
from surfexp.mesh.orientation import inside_out_components
from surfexp.mesh.repair import repair
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import require_valid, validate

Arrays = tuple[np.ndarray, np.ndarray]
SPHERE = icosphere(2).mesh


def arrays() -> Arrays:
    return SPHERE.vertices.copy(), SPHERE.faces.copy()


def repeated_index() -> Arrays:
    vertices, faces = arrays()
    return vertices, np.vstack([faces, [3, 3, 7]])


def zero_area() -> Arrays:
    """A vertex put on an edge with the flat triangle between it and the edge, as bad modellers do."""
    vertices, faces = arrays()
    a, b, c = faces[0]
    middle = len(vertices)
    vertices = np.vstack([vertices, 0.5 * (vertices[a] + vertices[b])])
    return vertices, np.vstack([[[a, middle, c], [middle, b, c]], faces[1:], [[a, b, middle]]])


def duplicate_face() -> Arrays:
    vertices, faces = arrays()
    return vertices, np.vstack([faces, faces[5][[1, 2, 0]]])


def duplicate_vertex() -> Arrays:
    """A seam: two hemispheres whose common vertices are there twice."""
    vertices, faces = arrays()
    upper = vertices[faces].mean(axis=1)[:, 2] > 0
    shifted = faces + len(vertices)
    both = np.where(upper[:, None], faces, shifted)
    used, numbers = np.unique(both, return_inverse=True)
    return np.vstack([vertices, vertices])[used], numbers.reshape(-1, 3)


def unreferenced() -> Arrays:
    vertices, faces = arrays()
    return np.vstack([vertices[:4], [[9.0, 9.0, 9.0]], vertices[4:]]), np.where(faces >= 4, faces + 1, faces)


def non_manifold_edge() -> Arrays:
    vertices, faces = arrays()
    return np.vstack([vertices, [[2.0, 2.0, 2.0]]]), np.vstack([faces, [faces[0][0], faces[0][1], len(vertices)]])


def non_manifold_vertex() -> Arrays:
    vertices, faces = arrays()
    other = vertices + 2 * vertices[0]
    # the second sphere touches the first in one vertex, its antipode of vertex 0
    antipode = int(np.linalg.norm(other - vertices[0], axis=1).argmin())
    numbers = np.arange(len(vertices)) + len(vertices)
    numbers[antipode] = 0
    return np.vstack([vertices, other]), np.vstack([faces, numbers[faces]])


def flipped() -> Arrays:
    vertices, faces = arrays()
    faces[[4, 50, 51]] = faces[[4, 50, 51]][:, ::-1]
    return vertices, faces


def inside_out() -> Arrays:
    vertices, faces = arrays()
    return vertices, faces[:, ::-1]


def moebius() -> Arrays:
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    sides = []
    for offset in (-0.3, 0.3):
        rho = 1 + offset * np.cos(angle / 2)
        sides.append(np.stack([rho * np.cos(angle), rho * np.sin(angle), offset * np.sin(angle / 2)], axis=1))
    faces = []
    for k in range(24):
        a, b, c, d = k, k + 1, 24 + k, 25 + k
        if k == 23:
            b, d = 24, 0
        faces += [[a, b, c], [b, d, c]]
    return np.concatenate(sides), np.array(faces)


PLANTED: dict[str, tuple[Callable[[], Arrays], int | None]] = {
    "faces with a repeated index": (repeated_index, 1),
    "zero-area faces": (zero_area, 1),
    "duplicate faces": (duplicate_face, 1),
    "duplicate vertices": (duplicate_vertex, None),
    "non-manifold edges": (non_manifold_edge, 1),
    "non-manifold vertices": (non_manifold_vertex, 1),
    "flipped faces": (flipped, 3),
    "faces of inside-out closed components": (inside_out, 320),
    "edges where no orientation is possible": (moebius, None),
}


@pytest.mark.parametrize("kind", PLANTED)
def test_defect_is_found_refused_and_mended(kind: str) -> None:
    make, count = PLANTED[kind]
    vertices, faces = make()
    report = validate(vertices, faces)
    assert not report.ok
    assert report.count(kind) == count if count is not None else report.count(kind) > 0
    with pytest.raises(
        ValueError, match=rf"mesh cow.obj has .*{kind}.*, or surfexp repair cow.obj --to repaired\.ply$"
    ):
        require_valid(TriangleMesh(vertices, faces), "cow.obj")
    mesh, changes, origin = repair(vertices, faces)
    assert validate(mesh.vertices, mesh.faces).ok
    assert changes
    assert np.linalg.norm(mesh.vertices - vertices[origin], axis=1).max() < 0.01


@pytest.mark.parametrize(
    "make", [repeated_index, duplicate_face, duplicate_vertex, unreferenced, non_manifold_edge, flipped, inside_out]
)
def test_repair_gives_the_sphere_back(make: Callable[[], Arrays]) -> None:
    mesh = repair(*make()).mesh
    assert (mesh.genus, mesh.is_closed, len(mesh.vertices)) == (0, True, len(SPHERE.vertices))
    assert mesh.area == pytest.approx(SPHERE.area, rel=1e-14)
    assert (mesh.face_normals * mesh.vertices[mesh.faces].mean(axis=1)).sum(axis=1).min() > 0


@pytest.mark.parametrize(("face", "named"), [([0, 1, 99], 99), ([0, 1, -2], -2), ([3, 1, 2], 3)])
def test_the_vertex_that_a_face_names_in_vain_is_told(face: list[int], named: int) -> None:
    with pytest.raises(ValueError, match=f"faces name vertex {named}, but the vertices are 0..2"):
        TriangleMesh(np.eye(3), np.array([[0, 1, 2], face]))


def test_what_is_cached_of_a_mesh_stays_true() -> None:
    """Positions and faces cannot be written over, while the arrays that were given can."""
    given = np.eye(3)
    mesh = TriangleMesh(given, np.array([[0, 1, 2]]))
    for array in (mesh.vertices, mesh.faces):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    given[0] = given[0]


def test_repair_of_a_face_without_area_keeps_the_surface() -> None:
    mesh = repair(*zero_area()).mesh
    assert mesh.is_closed and mesh.genus == 0
    assert mesh.area == pytest.approx(SPHERE.area, rel=1e-14)


def test_of_two_flips_that_would_double_an_edge_one_is_made() -> None:
    """Two flat faces whose middles are one vertex, under neighbours with one tip."""
    vertices = np.array([[-1.0, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, 0], [0, 0, 1]])
    faces = np.array([[0, 1, 4], [1, 0, 5], [2, 3, 4], [3, 2, 5]])
    changes: list[str] = []
    kept = TriangleMesh(vertices, flip_zero_area_faces(TriangleMesh(vertices, faces), changes))
    assert kept.area == pytest.approx(2.0) and kept.edge_face_counts.max() == 2
    assert [change.rpartition(": ")[2] for change in changes] == ["1 faces", "1 faces"]


def test_repair_separates_touching_spheres() -> None:
    mesh = repair(*non_manifold_vertex()).mesh
    assert mesh.component_count == 2 and mesh.is_closed
    assert len(mesh.vertices) == 2 * len(SPHERE.vertices)


def test_repair_cuts_a_moebius_band_into_an_orientable_one() -> None:
    mesh = repair(*moebius()).mesh
    assert mesh.component_count == 1 and len(mesh.boundary_loops) == 1
    assert len(mesh.faces) == 48 and mesh.euler_characteristic == 1


def test_scalar_map_follows_the_repair() -> None:
    vertices, faces = duplicate_vertex()
    repaired = repair(vertices, faces)
    assert (vertices[:, 2][repaired.origin] == repaired.mesh.vertices[:, 2]).all()


def test_largest_component() -> None:
    vertices, faces = arrays()
    twice = np.vstack([vertices, 0.1 * vertices + 5]), np.vstack([faces, faces + len(vertices)])
    assert validate(*twice).ok and validate(*twice).count("components") == 2
    with pytest.raises(ValueError, match="2 components, 1 is allowed"):
        require_valid(TriangleMesh(*twice), one_component=True)
    require_valid(TriangleMesh(*twice))
    mesh, changes, _ = repair(*twice, largest_component=True)
    assert mesh.component_count == 1 and mesh.area == pytest.approx(SPHERE.area)
    assert changes == ("dropped, all but the one of largest area: 1 components",)


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        (np.zeros((4, 2)), [[0, 1, 2]], "shape"),
        (np.eye(3), [[0, 1, 2, 0]], "shape"),
        (np.eye(3), [[0.0, 1.0, 2.0]], "shape or type"),
        (np.eye(3), np.zeros((0, 3), int), "missing faces"),
        (np.zeros((0, 3)), [[0, 1, 2]], "missing faces or vertices"),
        (np.diag([np.nan, 1.0, 1.0]), [[0, 1, 2]], "not finite"),
        (np.diag([np.inf, 1.0, 1.0]), [[0, 1, 2]], "not finite"),
        (np.eye(3), [[0, 1, 3]], "out of range"),
        (np.eye(3), [[0, 1, -1]], "out of range"),
    ],
)
def test_hopeless_arrays_are_refused_for_good(vertices: np.ndarray, faces: list[list[int]], words: str) -> None:
    report = validate(vertices, faces)
    assert not report.ok and words in report.lines()[0] and report.lines()[0].startswith("refuse")
    with pytest.raises(ValueError, match="no repair is possible"):
        repair(vertices, faces)


def test_nothing_left_is_refused() -> None:
    with pytest.raises(ValueError, match="nothing is left"):
        repair(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), [[0, 1, 2]])


def test_notes_do_not_refuse() -> None:
    report = validate(*(lambda mesh: (mesh.vertices * [1, 0.01, 1], mesh.faces))(disk(3).mesh))
    assert report.ok
    assert report.count("boundary loops") == 1
    assert report.count("faces with an angle under 5 degrees") > 10
    assert validate(*arrays()).lines() == ["no defect"]


def test_allowed_kinds_pass() -> None:
    require_valid(TriangleMesh(*flipped()), allow=("flipped faces",))


def test_a_vertex_without_faces_is_a_note_and_repair_drops_it() -> None:
    report = validate(*unreferenced())
    assert report.ok and report.lines() == ["note: 1 unreferenced vertices (vertex 4)"]
    assert repair(*unreferenced()).changes == ("dropped, because no face uses them: 1 vertices",)


def test_faces_at_vertices_without_position_are_cut_away() -> None:
    vertices, faces = arrays()
    vertices[7] = np.nan
    assert validate(vertices, faces).lines() == ["repairable: 1 vertices that are not finite (vertex 7)"]
    mesh, changes, origin = repair(vertices, faces)
    assert len(mesh.vertices) == len(vertices) - 1 and 7 not in origin and len(mesh.boundary_loops) == 1
    assert "not finite: 6 faces" in changes[0] or "not finite: 5 faces" in changes[0]


@st.composite
def spoiled(draw: st.DrawFn) -> Arrays:
    """A small mesh with random faces turned, doubled, redirected, vertices doubled and moved together."""
    base = draw(st.sampled_from([icosphere(1).mesh, disk(3).mesh]))
    vertices, faces = base.vertices.copy(), base.faces.copy()
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    turned = random.random(len(faces)) < draw(st.sampled_from([0.0, 0.2]))
    faces[turned] = faces[turned][:, ::-1]
    faces = np.vstack([faces, faces[random.integers(0, len(faces), draw(st.integers(0, 3)))]])
    for _ in range(draw(st.integers(0, 6))):
        faces[random.integers(len(faces)), random.integers(3)] = random.integers(len(vertices))
    for _ in range(draw(st.integers(0, 3))):
        vertices[random.integers(len(vertices))] = vertices[random.integers(len(vertices))]
    for _ in range(draw(st.integers(0, 2))):
        a, b, c = faces[random.integers(len(faces))]
        vertices[a] = 0.5 * (vertices[b] + vertices[c])
    extra = random.integers(0, len(vertices), (draw(st.integers(0, 4)), 3))
    return vertices, np.vstack([faces, extra])


@settings(max_examples=60, deadline=None)
@given(spoiled())
def test_repair_always_validates_and_is_idempotent(mesh: Arrays) -> None:
    repaired = repair(*mesh)
    report = validate(repaired.mesh.vertices, repaired.mesh.faces)
    assert report.ok, report.lines()
    assert bool(repaired.changes) == (not validate(*mesh).ok)
    again = repair(repaired.mesh.vertices, repaired.mesh.faces)
    assert again.changes == ()
    assert (again.mesh.faces == repaired.mesh.faces).all() and (again.mesh.vertices == repaired.mesh.vertices).all()
    assert np.linalg.norm(repaired.mesh.vertices - mesh[0][repaired.origin], axis=1).max(initial=0.0) < 0.05


SHELLS = [
    # signs of nested spheres from outside to inside, and what a repair makes of them
    ((1,), (1,)),
    ((-1,), (1,)),
    ((1, -1), (1, -1)),
    ((1, 1), (1, 1)),
    ((-1, 1), (1, -1)),
    ((-1, -1), (1, -1)),
    ((1, -1, 1), (1, -1, 1)),
    ((-1, 1, -1), (1, -1, 1)),
    ((1, -1, -1), (1, -1, 1)),
]


def shells(signs: tuple[int, ...], moved: float = 0.0) -> Arrays:
    count = len(SPHERE.vertices)
    vertices = [(len(signs) - k) * SPHERE.vertices + [k * moved, 0, 0] for k in range(len(signs))]
    faces = [(SPHERE.faces if sign > 0 else SPHERE.faces[:, ::-1]) + k * count for k, sign in enumerate(signs)]
    return np.concatenate(vertices), np.concatenate(faces)


@pytest.mark.parametrize(("signs", "expected"), SHELLS)
def test_cavities_stay_cavities(signs: tuple[int, ...], expected: tuple[int, ...]) -> None:
    mesh, changes, _ = repair(*shells(signs))
    blocks = mesh.faces.reshape(len(signs), -1, 3)
    found = [np.sign(np.linalg.det(mesh.vertices[block]).sum()) for block in blocks]
    assert tuple(found) == expected
    assert bool(changes) == (signs != expected)
    assert validate(*shells(signs)).ok == (signs == expected)


def test_beside_each_other_every_component_is_turned_outward() -> None:
    mesh, _, _ = repair(*shells((1, -1, -1), moved=10.0))
    assert (
        np.linalg.det((mesh.vertices - mesh.vertices.mean(axis=0))[mesh.faces]).reshape(3, -1).sum(axis=1) > 0
    ).all()


@pytest.mark.parametrize("lost", [np.nan, np.inf, 1e40])
def test_a_vertex_without_a_face_does_not_hide_what_is_inside_out(lost: float) -> None:
    ball = icosphere(1).mesh
    vertices = np.r_[ball.vertices, [[lost, 0.0, 0.0]]]
    sound, inward = (
        inside_out_components(TriangleMesh(vertices, faces)) for faces in (ball.faces, ball.faces[:, ::-1])
    )
    assert not sound.any() and inward.all()
