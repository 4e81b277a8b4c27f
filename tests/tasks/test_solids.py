"""Solids as a person hands them in: from files, turned over, broken; their shape DNA."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.tetrahedra import signed_volumes

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
CELLS = np.array([[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]])


def grid(cells: int) -> sx.Solid:
    places = np.array([[x, y, z] for x in range(cells + 1) for y in range(cells + 1) for z in range(cells + 1)])
    first = places[(places < cells).all(axis=1)] @ [(cells + 1) ** 2, cells + 1, 1]
    steps = (CUBE @ [(cells + 1) ** 2, cells + 1, 1]).astype(int)[CELLS]
    return sx.Solid(places / cells, (first[:, None, None] + steps).reshape(-1, 4))


def test_orientation_does_not_matter() -> None:
    one, other = sx.Solid(CUBE, CELLS), sx.Solid(CUBE, CELLS[:, [1, 0, 2, 3]])
    assert (signed_volumes(one.vertices, one.tetrahedra) > 0).all()
    assert (signed_volumes(other.vertices, other.tetrahedra) > 0).all()
    assert abs(one.stiffness - other.stiffness).max() < 1e-15 and one.volume == other.volume == pytest.approx(1.0)


def test_arrays_that_were_given_are_not_changed_and_not_changeable() -> None:
    cells = CELLS.copy()
    solid = sx.Solid(CUBE, cells)
    assert np.array_equal(cells, CELLS)
    with pytest.raises(ValueError, match="read-only"):
        solid.vertices[0, 0] = 3.0


@pytest.mark.parametrize(
    ("vertices", "tetrahedra", "message"),
    [
        (CUBE[:, :2], CELLS, r"vertices have shape \(8, 2\), \(count, 3\) is needed"),
        (CUBE, CELLS[:, :3], r"tetrahedra have shape \(6, 3\), \(count, 4\) is needed"),
        (CUBE, CELLS + 1, "tetrahedra have the vertex 8, 0 to 7 are there"),
        (CUBE, CELLS - 1, "tetrahedra have the vertex -1, 0 to 7 are there"),
        (np.where(CUBE == 0, np.nan, CUBE), CELLS, "vertices: 7 have no position"),
        (np.concatenate([CUBE, CUBE + 5]), CELLS, "8 vertices belong to no tetrahedron, the first is 8"),
        (CUBE * [1, 1, 0], CELLS, "6 tetrahedra have no volume, the first is 0"),
        (CUBE, [*CELLS, [0, 1, 1, 7]], "1 tetrahedra have no volume, the first is 6"),
        (CUBE, [*CELLS, CELLS[0]], "tetrahedra overlap at 4 triangles, the first has the vertices"),
        (np.concatenate([CUBE, [[0.9, 0.6, 0.3]]]), [*CELLS, [0, 1, 3, 8]], "tetrahedra overlap at 1 triangles"),
    ],
)
def test_what_is_no_solid_is_refused(vertices, tetrahedra, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sx.Solid(vertices, tetrahedra)


def test_two_on_one_side_of_a_triangle_are_refused() -> None:
    """Two tetrahedra alone, both above their common triangle."""
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1.0], [0.3, 0.3, 2.0]]
    with pytest.raises(ValueError, match="overlap at 1 triangles, the first has the vertices 0 1 2"):
        sx.Solid(vertices, [[0, 1, 2, 3], [0, 2, 1, 4]])
    below = [*vertices[:4], [0.3, 0.3, -2.0]]
    assert sx.Solid(below, [[0, 1, 2, 3], [0, 1, 2, 4]]).boundary.tolist() == [0, 1, 2, 3, 4]


def test_shape_dna_has_no_size_and_no_zero() -> None:
    solid = grid(6)
    free, held = solid.shape_dna(5), solid.shape_dna(5, boundary="dirichlet")
    exact = {"free": np.pi**2 * np.array([1, 1, 1, 2, 2]), "held": np.pi**2 * np.array([3, 6, 6, 6, 9])}
    assert free == pytest.approx(exact["free"], rel=0.1) and held == pytest.approx(exact["held"], rel=0.35)
    assert (free > exact["free"]).all() and (held > exact["held"]).all()
    large = sx.Solid(1000.0 * solid.vertices, solid.tetrahedra)
    assert large.shape_dna(5) == pytest.approx(free, rel=1e-8)
    assert len(free) == 5 and len(held) == 5


def test_every_piece_has_a_zero_of_its_own() -> None:
    solid = grid(3)
    count = len(solid.vertices)
    two = sx.Solid(
        np.concatenate([solid.vertices, solid.vertices + 9]),
        np.concatenate([solid.tetrahedra, solid.tetrahedra + count]),
    )
    one = solid.shape_dna(3) / solid.volume ** (2 / 3)
    assert two.shape_dna(6) / two.volume ** (2 / 3) == pytest.approx(np.repeat(one, 2), rel=1e-8)


def test_too_many_values_are_refused() -> None:
    with pytest.raises(ValueError, match=r"count = 8: the 8 free vertices have fewer values"):
        sx.Solid(CUBE, CELLS).shape_dna(8)
    with pytest.raises(ValueError, match=r"count = 1: the 0 free vertices"):
        sx.Solid(CUBE, CELLS).shape_dna(1, boundary="dirichlet")


@pytest.mark.optional
@pytest.mark.parametrize("name", ["a.vtk", "a.vtu", "a.msh", "a.mesh"])
def test_files_are_read(name: str, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    solid = grid(2)
    points = np.concatenate([[[7.0, 7.0, 7.0]], solid.vertices])
    cells = [
        ("triangle", np.array([[1, 2, 3]])),
        ("tetra", solid.tetrahedra[:10] + 1),
        ("tetra", solid.tetrahedra[10:] + 1),
    ]
    meshio.write(tmp_path / name, meshio.Mesh(points, cells))
    found = sx.Solid.read(tmp_path / name)
    np.testing.assert_allclose(found.vertices, solid.vertices, atol=1e-15)
    assert np.array_equal(found.tetrahedra, solid.tetrahedra)
    assert found.notes == (f"1 vertices of {tmp_path / name} belong to no tetrahedron and are left out.",)


@pytest.mark.optional
def test_files_that_are_no_solid_are_refused_in_one_line(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    meshio.write(tmp_path / "shell.vtk", meshio.Mesh(CUBE, [("triangle", np.array([[0, 1, 2]]))]))
    meshio.write(tmp_path / "bricks.vtk", meshio.Mesh(CUBE, [("hexahedron", np.arange(8)[None])]))
    (tmp_path / "words.msh").write_text("no mesh\n")
    (tmp_path / "poly.vtk").write_text(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\n"
    )
    (tmp_path / "a.nonsense").write_text("?")
    told = {
        "shell.vtk": "it has no tetrahedra, its cells are: triangle",
        "bricks.vtk": "it has cells of kind hexahedron, tetrahedra with four nodes are needed",
        "none.vtk": "there is no such file",
        "words.msh": "",
        "poly.vtk": "",
        "a.nonsense": "",
    }
    for name, words in told.items():
        with pytest.raises(ValueError, match=f"{name} cannot be read as tetrahedra: {words}") as refusal:
            sx.Solid.read(tmp_path / name)
        assert "\n" not in str(refusal.value)
