"""The transplantation of a pair of drums: the matrix that carries functions on one to functions on the other."""

from __future__ import annotations

import itertools

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shapes.isospectral_drum import TILES, Gluing, TransplantationPair
from surfexp.operators.elements_nodes import ElementNodes
from surfexp.operators.elements_surface import Boundary


def transplantation_matrix(pair: TransplantationPair, boundary: Boundary = "dirichlet") -> Floats:
    """(7, 7) invertible T of integers with T P_s = L_s T for all sides s (Berard 1992).

    P_s and L_s say which tile of the first and second drum lies beyond side s; where that is the boundary a tile reflects
    itself, with the sign -1 for Dirichlet's condition. With Neumann's, T is the incidence of points and lines of the Fano
    plane: each tile of the second drum adds three tiles of the first. Dirichlet's is the same up to signs.

    Raises
    ------
    ValueError
        If the pair is not one of points and lines.
    """
    orbits = _pair_orbits(pair)
    sizes = [int((orbits == number).sum()) for number in range(int(orbits.max()) + 1)]
    if sorted(sizes) != [21, 28]:
        raise ValueError(f"the tiles of the pair form orbits of {sizes}, transplantation needs 21 and 28")
    matrix = (orbits == sizes.index(21)).astype(np.float64)
    if boundary == "neumann":
        return matrix
    return np.outer(_mirror_signs(pair.second), _mirror_signs(pair.first)) * matrix


def transplant(
    pair: TransplantationPair, functions: Floats, first: ElementNodes, second: ElementNodes, boundary: Boundary
) -> tuple[Floats, float]:
    """Carry functions on the nodes of the first drum to the nodes of the second, tile by tile.

    Parameters
    ----------
    pair : TransplantationPair
    functions : (n, k) float64
        Values at all nodes, 0 on the rim under Dirichlet's condition.
    first, second : ElementNodes
        Both drums meshed by the same tile.
    boundary : "dirichlet" or "neumann"

    Returns
    -------
    functions : (n, k) float64
    tear : float
        Largest difference between values that two tiles give to one node; 0 to rounding.
    """
    matrix = transplantation_matrix(pair, boundary)
    width = first.connectivity.shape[1]
    on_tiles = functions[first.connectivity].reshape(TILES, -1, width, functions.shape[1])
    carried = np.einsum("ts,sfbk->tfbk", matrix, on_tiles).reshape(-1, functions.shape[1])
    places = second.connectivity.ravel()
    result = np.zeros((second.count, functions.shape[1]))
    result[places] = carried
    return result, float(np.abs(result[places] - carried).max())


def _pair_orbits(pair: TransplantationPair) -> Integers:
    """(7, 7) number of the orbit of (tile of the second, tile of the first) under the three reflections."""
    orbits = np.full((TILES, TILES), -1, np.int64)
    for start in itertools.product(range(TILES), repeat=2):
        if orbits[start] >= 0:
            continue
        number, waiting = int(orbits.max()) + 1, [start]
        orbits[start] = number
        for line, point in waiting:
            for side in range(3):
                beyond = pair.second[side][line], pair.first[side][point]
                if orbits[beyond] < 0:
                    orbits[beyond] = number
                    waiting.append(beyond)
    return orbits


def _mirror_signs(gluing: Gluing) -> Floats:
    """1 on the tiles that lie as the first one does, -1 on its mirror images."""
    signs, waiting = np.zeros(TILES), [0]
    signs[0] = 1.0
    for tile in waiting:
        for permutation in gluing:
            if signs[permutation[tile]] == 0.0:
                signs[permutation[tile]] = -signs[tile]
                waiting.append(permutation[tile])
    return signs
