"""Linear elements on tetrahedra: exact integrals, and the known spectra of a box and of a ball."""

from __future__ import annotations

from functools import cache
from itertools import combinations, permutations, product

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.sparse import csr_array
from scipy.special import spherical_jn

import surfexp as sx
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.solid_elements import solid_mass, solid_stiffness

SIDES = np.array([1.0, 1.3, 0.7])


@cache
def box(cells: int) -> sx.Solid:
    grid = np.array(list(product(range(cells + 1), repeat=3)))
    walks = np.array(
        [np.cumsum([[0, 0, 0], *np.eye(3, dtype=int)[list(order)]], axis=0) for order in permutations(range(3))]
    )
    corners = grid[(grid < cells).all(axis=1)][:, None, None] + walks
    return sx.Solid(grid / cells * SIDES, (corners @ [(cells + 1) ** 2, cells + 1, 1]).reshape(-1, 4))


@cache
def ball(levels: int) -> sx.Solid:
    """Cones over an icosahedron, each cut into eight at every level, and stretched to a ball at the end."""
    shell = icosphere(0).mesh
    points = np.concatenate([shell.vertices, np.zeros((1, 3))])
    cells = np.column_stack([np.full(len(shell.faces), len(shell.vertices)), shell.faces])
    for _ in range(levels):
        pairs = cells[:, list(combinations(range(4), 2))].reshape(-1, 2)
        edges, numbers = np.unique(np.sort(pairs, axis=1), axis=0, return_inverse=True)
        a, b, c, d = cells.T
        ab, ac, ad, bc, bd, cd = (numbers.reshape(-1, 6) + len(points)).T
        points = np.concatenate([points, points[edges].mean(axis=1)])
        parts = [(a, ab, ac, ad), (ab, b, bc, bd), (ac, bc, c, cd), (ad, bd, cd, d)]
        parts += [(ab, ac, ad, bd), (ab, ac, bc, bd), (ac, ad, bd, cd), (ac, bc, bd, cd)]
        cells = np.concatenate([np.stack(part, axis=1) for part in parts])
    normals = shell.face_normals
    depth = (points @ normals.T).max(axis=1) / (shell.vertices[shell.faces[0, 0]] @ normals[0])
    lengths = np.linalg.norm(points, axis=1)
    return sx.Solid(points * (depth / np.where(lengths > 0, lengths, 1.0))[:, None], cells)


def dirichlet(solid: sx.Solid, count: int) -> np.ndarray:
    free = np.setdiff1d(np.arange(len(solid.vertices)), solid.boundary)
    a, b = (csr_array(matrix[free][:, free]) for matrix in (solid.stiffness, solid.mass))
    return np.asarray(sx.eigsh(a, k=count, M=b, sigma=0, return_eigenvectors=False))


def neumann(solid: sx.Solid, count: int) -> np.ndarray:
    return np.asarray(sx.eigsh(solid.stiffness, k=count, M=solid.mass, sigma=0, return_eigenvectors=False))


def box_values(first: int, count: int) -> np.ndarray:
    waves = np.array(list(product(range(first, 8), repeat=3)))
    return np.sort(np.pi**2 * ((waves / SIDES) ** 2).sum(axis=1))[:count]


def ball_values(derivative: bool, count: int) -> np.ndarray:
    """Squares of the zeros of j_l (held boundary) or of its derivative (free), each 2 l + 1 times."""
    values, grid = [0.0] if derivative else [], np.linspace(0.5, 12.0, 400)
    for degree in range(8):
        signs = spherical_jn(degree, grid, derivative)
        for i in np.flatnonzero(signs[:-1] * signs[1:] < 0):
            root = brentq(
                lambda x, degree=degree: spherical_jn(degree, x, derivative), grid[i], grid[i + 1], xtol=1e-13
            )
            values += [root**2] * (2 * degree + 1)
    return np.sort(values)[:count]


def test_integrals_of_linear_functions_are_exact() -> None:
    solid = box(3)
    a, b, ones = solid.stiffness, solid.mass, np.ones(len(solid.vertices))
    slope = np.array([2.0, -1.0, 0.5])
    linear = solid.vertices @ slope
    assert solid.volume == pytest.approx(SIDES.prod(), rel=1e-13)
    assert ones @ (b @ ones) == pytest.approx(solid.volume, rel=1e-13)
    assert np.abs(a @ ones).max() < 1e-12
    assert linear @ (a @ linear) == pytest.approx(slope @ slope * solid.volume, rel=1e-12)
    for axis, side in enumerate(SIDES):
        x = solid.vertices[:, axis]
        assert x @ (b @ x) == pytest.approx(solid.volume * side**2 / 3.0, rel=1e-12)
    inner = np.setdiff1d(np.arange(len(ones)), solid.boundary)
    assert len(inner) == 8 and np.abs((a @ linear)[inner]).max() < 1e-12


def test_one_tetrahedron_by_hand() -> None:
    vertices, cell = np.concatenate([np.zeros((1, 3)), np.eye(3)]), np.array([[0, 1, 2, 3]])
    assert solid_stiffness(vertices, cell).toarray() * 6.0 == pytest.approx(
        np.array([[3, -1, -1, -1], [-1, 1, 0, 0], [-1, 0, 1, 0], [-1, 0, 0, 1]])
    )
    assert solid_mass(vertices, cell).toarray() * 120.0 == pytest.approx(np.ones((4, 4)) + np.eye(4))


@pytest.mark.parametrize(("solve", "first"), [(neumann, 0), (dirichlet, 1)])
def test_the_spectrum_of_a_box_converges_at_rate_two(solve, first) -> None:
    exact = box_values(first, 10)
    coarse, fine = (solve(box(cells), 10) - exact for cells in (8, 16))
    some = exact > 0
    assert (fine[some] > 0).all() and (fine[some] / exact[some]).max() < 0.08
    rate = np.log2(coarse[some].sum() / fine[some].sum())
    assert 1.9 < rate < 2.15, rate


@pytest.mark.slow
@pytest.mark.parametrize(("solve", "derivative"), [(neumann, True), (dirichlet, False)])
def test_the_spectrum_of_a_ball_converges_at_rate_two(solve, derivative) -> None:
    exact = ball_values(derivative, 10)
    errors = [solve(ball(levels), 10) - exact for levels in (2, 3, 4)]
    some = exact > 0
    sums = [np.abs(error[some]).sum() for error in errors]
    assert np.abs(errors[-1][some] / exact[some]).max() < 0.02
    assert 1.8 < np.log2(sums[1] / sums[2]) < 2.2, sums


def test_no_pair_of_a_multiple_value_is_missing() -> None:
    """The held modes of a ball come 1, 3, 5, 1 and 7 at a time; dense algebra on the same matrices has them all."""
    solid = ball(3)
    free = np.setdiff1d(np.arange(len(solid.vertices)), solid.boundary)
    a, b = (matrix[free][:, free].toarray() for matrix in (solid.stiffness, solid.mass))
    exact = eigh(a, b, eigvals_only=True, subset_by_index=(0, 16))
    assert dirichlet(solid, 17) == pytest.approx(exact, rel=1e-8)
    assert exact == pytest.approx(ball_values(False, 17), rel=0.12)


@pytest.mark.optional
def test_matrices_are_those_of_lapy() -> None:
    lapy = pytest.importorskip("lapy")
    solid = ball(2)
    solver = lapy.Solver(lapy.TetMesh(solid.vertices, np.array(solid.tetrahedra)))
    for ours, theirs in ((solid.stiffness, solver.stiffness), (solid.mass, solver.mass)):
        assert abs(ours - theirs).max() < 1e-6 * abs(ours).max()
