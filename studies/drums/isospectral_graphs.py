"""Graphs that sound the same: small graphs glued as the tiles of isospectral drums are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.isospectral_drum import TILES, Gluing, TransplantationPair

# a vertex for each side of the tile, joined in a path, and one more that tells the ends of the path apart
PATH = np.array([[0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]])


@dataclass(frozen=True)
class GraphComparison:
    """What was found of two graphs.

    Parameters
    ----------
    vertices, edges : int
        Of the first.
    adjacency_difference, laplacian_difference : float
        Largest difference of the spectra, of the graphs with a loop for each side on the rim, and without loops.
    isomorphic : bool
        Whether the graphs without loops are the same up to names.
    """

    vertices: int
    edges: int
    adjacency_difference: float
    laplacian_difference: float
    isomorphic: bool


def glued_graph(gluing: Gluing, tile: Floats = PATH) -> Floats:
    """(7 v, 7 v) adjacency of seven copies of a graph; vertex s of two copies is joined where they meet in side s.

    Parameters
    ----------
    gluing : three permutations
    tile : (v, v) float64
        Adjacency of a graph whose first three vertices stand for the sides.

    Returns
    -------
    (7 v, 7 v) float64
        A side on the rim is a loop, 1 on the diagonal, which the Laplacian does not see.
    """
    count = len(tile)
    adjacency = np.kron(np.eye(TILES), tile)
    for side, permutation in enumerate(gluing):
        for copy in range(TILES):
            adjacency[copy * count + side, permutation[copy] * count + side] += 1.0
    return np.asarray(adjacency, dtype=np.float64)


def compare_graphs(pair: TransplantationPair, tile: Floats = PATH) -> GraphComparison:
    """Glue both graphs of a pair and compare their spectra, which the transplantation makes equal, and the graphs.

    Raises
    ------
    ValueError
        If the tile is no symmetric 0-1 matrix of at least three vertices.
    """
    if len(tile) < 3 or tile.shape != tile.T.shape or (tile != tile.T).any() or not np.isin(tile, (0.0, 1.0)).all():
        raise ValueError(f"the tile is a {tile.shape} matrix; take a symmetric one of 0 and 1, at least 3 x 3")
    import networkx

    both = [glued_graph(gluing, tile) for gluing in (pair.first, pair.second)]
    simple = [adjacency - np.diag(adjacency.diagonal()) for adjacency in both]
    laplacians = [np.diag(adjacency.sum(axis=1)) - adjacency for adjacency in simple]
    first, second = (networkx.from_numpy_array(adjacency) for adjacency in simple)
    return GraphComparison(
        vertices=first.number_of_nodes(),
        edges=first.number_of_edges(),
        adjacency_difference=_difference(both),
        laplacian_difference=_difference(laplacians),
        isomorphic=bool(networkx.is_isomorphic(first, second)),
    )


def _difference(matrices: list[Floats]) -> float:
    one, two = (np.linalg.eigvalsh(matrix) for matrix in matrices)
    return float(np.abs(one - two).max())
