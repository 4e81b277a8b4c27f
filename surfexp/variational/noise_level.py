"""The standard deviation of the noise in a map, estimated from the map and the mesh alone."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.edge_table import edge_table
from surfexp.operators.surface_operator import SurfaceOperator

# median of the modulus of a standard normal variable
NORMAL_MEDIAN = 0.6744897501960817
FEWEST_PAIRS = 20


def noise_level(operator: SurfaceOperator, values: Floats) -> float:
    """Estimate the standard deviation of independent noise at the vertices, robust against edges of the image.

    Two triangles at a common edge, unfolded into the plane, have four corners and so one affine relation c (c sums to 0
    and annihilates both coordinates). With |c| = 1 the number c . f of such a pair is free of every function that is
    affine on it, and noise of deviation sigma gives it deviation sigma. The median of |c . f| over all pairs, over the
    median of a normal variable (Donoho's rule for wavelet coefficients), is the estimate; it errs upward by the second
    derivatives of the clean map times h^2, and edges touch too few pairs to move a median.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) or (n, c) float64
        Channels are pooled.

    Returns
    -------
    float
        In the unit of the map.

    Raises
    ------
    ValueError
        If the surface has under 20 pairs of neighbouring triangles.

    References
    ----------
    Donoho, Johnstone: Ideal spatial adaptation by wavelet shrinkage (1994).
    """
    corners, relations = affine_relations(operator)
    if len(corners) < FEWEST_PAIRS:
        raise ValueError(
            f"the surface has {len(corners)} pairs of triangles, an estimate needs {FEWEST_PAIRS}: give noise"
        )
    channels = np.reshape(values, (len(values), -1))
    deviations = np.abs(np.einsum("ek,ekc->ec", relations, channels[corners]))
    return float(np.median(deviations)) / NORMAL_MEDIAN


def pair_count(operator: SurfaceOperator) -> int:
    """Return how many pairs of neighbouring triangles a surface has."""
    return len(_face_pairs(operator.faces)[0])


def affine_relations(operator: SurfaceOperator) -> tuple[Integers, Floats]:
    """Return the corners of every pair of neighbouring triangles, and their affine relation once they are unfolded.

    Returns
    -------
    (e, 4) int64
        The ends of the common edge, then the two corners opposite to it.
    (e, 4) float64
        Rows of length 1 whose products with functions that are affine on the pair vanish.
    """
    face, tip = _face_pairs(operator.faces)
    start = operator.faces[face[:, 0], (tip[:, 0] + 1) % 3]
    stop = operator.faces[face[:, 0], (tip[:, 0] + 2) % 3]
    # the gradient of the hat function of a tip has the length 1 / height and points away from the common edge
    gradients = operator.hat_gradients
    slopes = gradients[face, tip]
    squares = np.einsum("eki,eki->ek", slopes, slopes)
    corner_of_stop = np.argmax(operator.faces[face] == stop[:, None, None], axis=2)
    feet = -np.einsum("eki,eki->ek", gradients[face, corner_of_stop], slopes) / squares
    shares = np.sqrt(squares)
    shares /= shares.sum(axis=1, keepdims=True)
    crossing = (shares * feet).sum(axis=1)
    relations = np.column_stack([crossing - 1.0, -crossing, shares])
    corners = np.column_stack([start, stop, operator.faces[face, tip]])
    return corners, relations / np.linalg.norm(relations, axis=1, keepdims=True)


def _face_pairs(faces: Integers) -> tuple[Integers, Integers]:
    """(e, 2) faces on the two sides of every interior edge, and (e, 2) the corner of each that is not on it."""
    tails, heads = faces[:, [1, 2, 0]].T.ravel(), faces[:, [2, 0, 1]].T.ravel()
    table = edge_table(tails, heads, int(faces.max(initial=-1)) + 1)
    first = table.starts[:-1][table.counts == 2]
    both = table.half_edges[np.column_stack([first, first + 1])]
    return both % len(faces), both // len(faces)
