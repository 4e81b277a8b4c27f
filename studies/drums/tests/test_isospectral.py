"""Isospectral drums: equal discrete spectra, the reference values, and that the drums differ."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from surfexp.mesh.shapes.isospectral_drum import (
    GORDON_WEBB_WOLPERT,
    RIGHT_ISOSCELES,
    TransplantationPair,
    glued_drum,
    tile_layout,
    tile_mesh,
)
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp_studies.drums.drum_elements import GORDON_WEBB_WOLPERT_VALUES, drum_elements
from surfexp_studies.drums.isospectral_graphs import PATH, compare_graphs
from surfexp_studies.drums.transplantation import transplant, transplantation_matrix
from surfexp_studies.drums.transplantation_pairs import transplantation_pairs

TRIANGLES = {
    "isosceles": RIGHT_ISOSCELES,
    "scalene": np.array([[0.0, 0.0], [1.7, 0.1], [0.4, 1.1]]),
    "obtuse": np.array([[0.0, 0.0], [1.0, 0.0], [-0.5, 0.8]]),
}


def polygon(gluing, triangle: np.ndarray) -> np.ndarray:
    """(k, 2, 2) sides of the outline."""
    tiles = tile_layout(gluing, triangle)
    sides = [
        (tiles[t, (s + 1) % 3], tiles[t, (s + 2) % 3])
        for s, permutation in enumerate(gluing)
        for t in range(7)
        if permutation[t] == t
    ]
    return np.array(sides)


def random_tile(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A tile mesh of no symmetry: inner nodes and side nodes moved at random along their sides."""
    points, faces = tile_mesh(5)
    rng = np.random.default_rng(seed)
    moved = points * np.exp(0.2 * rng.normal(size=points.shape))
    return moved / moved.sum(axis=1, keepdims=True), faces


def test_there_are_seven_pairs_of_trees_of_reflections() -> None:
    pairs = transplantation_pairs()
    assert len(pairs) == 7
    for gluing in itertools.chain.from_iterable((pair.first, pair.second) for pair in pairs):
        for permutation in gluing:
            assert [permutation[permutation[t]] for t in range(7)] == list(range(7))
            assert sum(permutation[t] != t for t in range(7)) == 4


@pytest.mark.parametrize("triangle", TRIANGLES)
@pytest.mark.parametrize("pair", range(7))
@pytest.mark.parametrize("boundary", ["dirichlet", "neumann"])
def test_pairs_have_equal_discrete_spectra_on_any_tile_mesh(pair: int, triangle: str, boundary: str) -> None:
    chosen = transplantation_pairs()[pair]
    spectra = []
    for gluing in (chosen.first, chosen.second):
        elements = drum_elements(glued_drum(gluing, TRIANGLES[triangle], *random_tile(pair)), 2, boundary)
        spectra.append(eigenpairs(elements.stiffness, elements.mass, 20, "slicing", tolerance=1e-11).values)
    scale = np.maximum(spectra[0], spectra[0][1])
    assert np.abs((spectra[0] - spectra[1]) / scale).max() < 1e-12


def test_a_wrong_gluing_is_heard() -> None:
    chosen = transplantation_pairs()[0]
    wrong = (chosen.second[1], chosen.second[0], chosen.second[2])
    values = []
    for gluing in (chosen.first, wrong):
        elements = drum_elements(glued_drum(gluing, TRIANGLES["scalene"], *tile_mesh(5)), 2)
        values.append(eigenpairs(elements.stiffness, elements.mass, 10).values)
    assert np.abs(values[0] / values[1] - 1.0).max() > 1e-3


def test_gordon_webb_wolpert_reference_values() -> None:
    errors = []
    for divisions in (12, 24):
        elements = drum_elements(glued_drum(GORDON_WEBB_WOLPERT.second, RIGHT_ISOSCELES, *tile_mesh(divisions, 3.0)), 3)
        values = eigenpairs(elements.stiffness, elements.mass, 25).values
        errors.append(np.abs(values[:10] / GORDON_WEBB_WOLPERT_VALUES - 1.0).max())
    assert errors[0] < 1e-4 and errors[1] < 3e-6
    assert np.log2(errors[0] / errors[1]) > 4.0


def test_the_two_drums_are_not_congruent() -> None:
    outlines = [polygon(g, RIGHT_ISOSCELES) for g in (GORDON_WEBB_WOLPERT.first, GORDON_WEBB_WOLPERT.second)]
    spreads = []
    for sides in outlines:
        corners = np.unique(np.round(sides.reshape(-1, 2), 9), axis=0)
        spreads.append(np.sort(np.linalg.norm(corners[:, None] - corners[None], axis=2).ravel()))
    lengths = [np.linalg.norm(sides[:, 0] - sides[:, 1], axis=1).sum() for sides in outlines]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-12)  # perimeter is heard (Kac 1966) ...
    assert len(spreads[0]) != len(spreads[1]) or np.abs(spreads[0] - spreads[1]).max() > 0.1  # ... the shape is not


def test_area_is_seven_tiles() -> None:
    drum = glued_drum(GORDON_WEBB_WOLPERT.first, RIGHT_ISOSCELES, *tile_mesh(3))
    assert drum_elements(drum, 1).area == pytest.approx(14.0, rel=1e-12)
    chi = len(drum.vertices) - len(drum_edges(drum.faces)) + len(drum.faces)
    assert chi == 1


def drum_edges(faces: np.ndarray) -> np.ndarray:
    return np.unique(np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)


def test_unfit_tiles_are_refused() -> None:
    with pytest.raises(ValueError, match="lie on a line"):
        glued_drum(GORDON_WEBB_WOLPERT.first, np.array([[0.0, 0], [1, 0], [2, 0]]), *tile_mesh(2))
    with pytest.raises(ValueError, match="at least 1"):
        tile_mesh(0)


@pytest.mark.parametrize("pair", [GORDON_WEBB_WOLPERT, *transplantation_pairs()])
@pytest.mark.parametrize("boundary", ["dirichlet", "neumann"])
def test_transplantation_intertwines_the_reflections(pair: TransplantationPair, boundary: str) -> None:
    carried = transplantation_matrix(pair, boundary)
    sign = -1.0 if boundary == "dirichlet" else 1.0
    for first, second in zip(pair.first, pair.second, strict=True):
        reflections = []
        for permutation in (first, second):
            matrix = np.eye(7)[list(permutation)]
            matrix[np.diag_indices(7)] *= sign
            reflections.append(matrix)
        assert (carried @ reflections[0] == reflections[1] @ carried).all()
    assert abs(np.linalg.det(carried)) == pytest.approx(24.0)


@pytest.mark.parametrize("boundary", ["dirichlet", "neumann"])
@pytest.mark.parametrize("order", [1, 3])
def test_transplanted_modes_are_modes(boundary: str, order: int) -> None:
    pair = transplantation_pairs()[2]
    one, two = (
        drum_elements(glued_drum(gluing, TRIANGLES["scalene"], *random_tile(1)), order, boundary)
        for gluing in (pair.first, pair.second)
    )
    system = eigenpairs(one.stiffness, one.mass, 8, tolerance=1e-11)
    moved, tear = transplant(pair, one.extend(system.vectors), one.nodes, two.nodes, boundary)
    assert tear < 1e-12 and np.abs(moved).max() > 0.1
    inside = moved[two.free]
    defect = two.stiffness @ inside - two.mass @ inside * system.values
    assert np.abs(defect).max() < 1e-9 * system.values[-1]
    if boundary == "dirichlet":
        assert np.abs(moved[two.nodes.boundary]).max() < 1e-12
    # without the signs the pieces still fit, but fold along the sides
    wrong = transplant(pair, one.extend(system.vectors), one.nodes, two.nodes, "neumann")[0][two.free]
    folded = two.stiffness @ wrong - two.mass @ wrong * system.values
    assert boundary == "neumann" or np.abs(folded).max() > 1e-3 * system.values[-1]


def test_drums_of_no_pair_have_no_transplantation() -> None:
    with pytest.raises(ValueError, match="needs 21 and 28"):
        transplantation_matrix(TransplantationPair(GORDON_WEBB_WOLPERT.first, GORDON_WEBB_WOLPERT.first))


@pytest.mark.parametrize("pair", [GORDON_WEBB_WOLPERT, *transplantation_pairs()])
def test_glued_graphs_sound_the_same_and_differ(pair: TransplantationPair) -> None:
    found = compare_graphs(pair)
    assert found.vertices == 28 and found.edges == 27
    assert found.adjacency_difference < 1e-12 and found.laplacian_difference < 1e-12
    assert not found.isomorphic


def test_a_wrong_gluing_of_graphs_is_heard() -> None:
    pair = transplantation_pairs()[0]
    wrong = TransplantationPair(pair.first, (pair.second[1], pair.second[0], pair.second[2]))
    assert compare_graphs(wrong).laplacian_difference > 1e-3
    assert compare_graphs(TransplantationPair(pair.first, pair.first)).isomorphic
    with pytest.raises(ValueError, match="at least 3 x 3"):
        compare_graphs(pair, np.ones((2, 2)))


def test_the_tile_of_the_graphs_is_a_path_of_four() -> None:
    degrees = PATH.sum(axis=0)
    assert np.array_equal(PATH, PATH.T) and not np.diag(PATH).any() and set(np.unique(PATH)) == {0.0, 1.0}
    assert sorted(degrees) == [1.0, 1.0, 2.0, 2.0] and np.linalg.matrix_power(PATH + np.eye(4), 3).all()
