"""What does not fit is refused by the function that would give a wrong number, with the thing and its value."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import csr_array, eye_array

import surfexp as sx
from surfexp.anatomy import fsaverage5 as packaged
from surfexp.embedding.analytic_spectra import spheroid_embedding
from surfexp.extras import MissingExtra
from surfexp.io.numbers import real_array
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.operators.fem import fem
from surfexp.operators.matrix_operator import matrix_operator
from surfexp.operators.vertex_averaged import vertex_averaged
from surfexp.skeleton.level_selection import choose_levels
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.separation import retrieval
from surfexp.variational.normal_filtering import NormalFiltering
from surfexp.variational.requirements import check_combination
from surfexp.variational.separable_quadratic import convex_chan_vese, rof
from surfexp.variational.solvers import conic as conic_module
from surfexp.variational.solvers.chambolle_dual import chambolle_dual

BALL = icosphere(2)
MESH = BALL.mesh
N = len(MESH.vertices)
RING = torus().mesh
LOOSE = TriangleMesh(np.vstack([MESH.vertices, [[9.0, 9.0, 9.0]]]), MESH.faces)


def averaged_conic() -> object:
    operator = vertex_averaged(MESH)
    return conic_module.conic(rof(operator.mass, np.zeros(N), 1.0), operator)


def segmented_by_chambolle() -> object:
    operator = fem(MESH)
    return chambolle_dual(convex_chan_vese(operator.mass, MESH.vertices[:, 0].copy()), operator)


CASES: dict[str, tuple[Callable[[], object], str]] = {
    "mass of elements": (lambda: surface_elements(MESH, mass="lump"), "mass 'lump' is unknown"),
    "boundary of elements": (lambda: surface_elements(MESH, boundary="dirichlet"), "closed and has no boundary"),
    "length of a right-hand side": (
        lambda: ldlt(csr_array(eye_array(5))).solve(np.ones(4)), "right-hand side has 4 rows, the matrix has 5",
    ),
    "semiaxis": (lambda: spheroid_embedding(-1.0, 3), "semiaxis -1"),
    "semiaxis of nothing": (lambda: spheroid_embedding(float("nan"), 3), "semiaxis nan"),
    "weight of normals": (lambda: NormalFiltering(weight=0.0).run(MESH), "^weight is 0"),
    "levels between critical values": (
        lambda: choose_levels(RING, RING.vertices[:, 0], 1, "critical"), "1 levels cannot separate 4 critical values",
    ),
    "a class of one": (lambda: retrieval(1.0 - np.eye(3), ["a", "b", "c"]), "none of 3 members has another"),
    "model": (lambda: check_combination("newton", "rofl"), "model 'rofl' is unknown"),
    "solver of a model": (lambda: check_combination("newton", "multiphase"), "does not solve model 'multiphase'"),
    "conic and averages": (averaged_conic, "conic descends an energy and .* has none"),
    "chambolle_dual without strong convexity": (segmented_by_chambolle, "chambolle_dual"),
    "the vertex that a face names": (lambda: TriangleMesh(np.eye(3), [[0, 1, 99]]), "faces name vertex 99"),
    "a face before the first vertex": (lambda: TriangleMesh(np.eye(3), [[0, 1, -2]]), "faces name vertex -2"),
    "distances with a slight asymmetry": (
        lambda: DistanceMatrix(("a", "b"), np.array([[0.0, 1.0], [1.0 + 1e-6, 0.0]])), "asymmetry 1.0e-06",
    ),
    "distance to oneself": (
        lambda: DistanceMatrix(("a", "b"), np.array([[1e-6, 1.0], [1.0, 0.0]])), "0 to oneself",
    ),
    "eigenvalues about a point": (
        lambda: sx.eigsh(csr_array(eye_array(9)), k=2, sigma=0.5), "sigma = 0.5.* only the lowest pairs",
    ),
    "numbers that are words": (lambda: real_array(np.array(["a"]), "x"), "x is an array of type <U1"),
    "numbers in records": (lambda: real_array(np.zeros(2, dtype=[("a", float)]), "x"), "type structured"),
    "matrices on a mesh with a loose vertex": (
        lambda: matrix_operator(LOOSE, csr_array((N + 1, N + 1)), csr_array(eye_array(N + 1)), "own"),
        f"vertex {N} belongs to no face",
    ),
    "matrix of another size": (
        lambda: matrix_operator(MESH, csr_array(eye_array(3)), csr_array(eye_array(3)), "own"), "has shape",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", CASES)
def test_what_does_not_fit_is_refused(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conic_module, "require_installed", lambda *names: None)
    call, said = CASES[what]
    with pytest.raises(ValueError, match=said):
        call()


def test_labels_of_another_surface_are_refused(tmp_path: Path) -> None:
    sx.write(tmp_path / "ball.ply", BALL)
    sx.write(tmp_path / "parts.label.gii", np.arange(10) % 2)
    with pytest.raises(ValueError, match=f"labels 'parts' have 10 entries, .* has {N} vertices"):
        sx.read(tmp_path / "ball.ply", labels={"parts": tmp_path / "parts.label.gii"})


def test_a_packaged_file_that_is_gone_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Package:
        origin = str(tmp_path / "nilearn" / "__init__.py")

    monkeypatch.setattr(packaged, "find_spec", lambda name: Package)
    with pytest.raises(ValueError, match=r"nilearn's file pial_left.gii.gz is missing from .*fsaverage5"):
        packaged._packaged("pial_left")


def test_a_package_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packaged, "find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match="pip install"):
        packaged._packaged("pial_left")
