"""Spectral distance of two surfaces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import get_args

import numpy as np
from scipy.sparse import csr_array

from surfexp.embedding.distance import Distance
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks
from surfexp.embedding.mean_hausdorff import HausdorffObjective
from surfexp.embedding.representatives import Represented, distance_by_representatives, represented
from surfexp.embedding.rival_maps import competing_signs
from surfexp.embedding.sign_search import Progress
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, Weighting
from surfexp.mesh.given_numbers import one_of, whole_number
from surfexp.mesh.surface_part import SurfacePart
from surfexp.spectrum.eigensystem import SMALLEST_GAP
from surfexp.tasks.embedded_surface import embedded
from surfexp.tasks.given_surface import SurfaceLike

# pairs of points that a search compares at most where no limit is given: about a minute
LARGEST_SEARCH, FEWEST, MOST = 2e10, 100, 2000
# pairs of points of which each evaluation compares all; where there are more, some points stand for the others
LARGEST_PAIR, REPRESENTATIVES = 2e9, 7000
# distances that differ by less, of themselves or of the mean length of a point, are the same up to rounding
SAME_DISTANCE, OF_A_POINT = 1e-5, 1e-6


def distance(
    source: SurfaceLike,
    target: SurfaceLike,
    n: int = 20,
    *,
    weighting: Weighting = "biharmonic",
    limit: int | None = None,
    points: int | None = None,
    progress: Progress | None = None,
) -> Distance:
    """Return the spectral distance of two surfaces, minimised over the signs of their eigenfunctions, with the proof.

    Both surfaces are scaled to area 1, so that size and pose do not matter. Eigenvalues are taken to be simple: of several
    that are equal, as on a body with a symmetry of rotation, any rotation of their eigenfunctions is as good, the distance
    depends on the one that the solver gave, and a note says so.

    Parameters
    ----------
    source, target : Surface, path, or (vertices, faces)
        The parts inside their masks are compared.
    n : int
        Number of eigenfunctions.
    weighting : "biharmonic", "global_point", "heat_kernel" or "diffusion"
        Biharmonic weights converge with n, those of the global point signature do not.
    limit : int, optional
        Most evaluations of the search. Where the proof needs more, `lower_bound` is below `value`. The default compares 2e10
        pairs of points, in 100 to 2,000 evaluations: 400 for two surfaces of 7,000 vertices. Above 14,142 vertices each, 100
        take longer: up to 8 minutes for 40,000.
    points : int, optional
        How many vertices of each surface stand for the others in the search; with as many or fewer all are compared. The
        default is 7,000 for two surfaces with more than 2e9 pairs of vertices (44,721 each), else all. `value` is that of all
        vertices, each matched with one that is at most twice as far as the nearest, and mostly with that. `lower_bound` holds
        for all, but is lower by what the representatives leave out, so that nothing above 0 is proved least; a note says how
        much. Symmetries are not looked for.
    progress : callable, optional
        Called with the number of evaluations and the relative gap that is left.

    Returns
    -------
    Distance
        `value`, `lower_bound`, `optimal`, the signs on the diagonal of `basis`, and `correspondence`: for each vertex of the
        target one of the source, -1 outside the mask. A note says where other signs give the same distance, as on a body with
        a mirror symmetry. Lengths on the surface then cannot tell which map is right.

    Raises
    ------
    ValueError
        If a mesh is unfit or too coarse for n eigenfunctions.

    Examples
    --------
    >>> import surfexp as sx
    >>> found = sx.distance(sx.shape("ellipsoid", levels=3), sx.shape("ellipsoid", levels=3), n=5)
    >>> round(found.value, 9), found.optimal
    (0.0, True)
    """
    n = whole_number(n, "n", 1)
    limit = None if limit is None else whole_number(limit, "limit", 1)
    one_of(weighting, "weighting", get_args(Weighting))
    points = None if points is None else whole_number(points, "points", 1)
    (first, first_part), (second, second_part) = embedded(source, n, weighting), embedded(target, n, weighting)
    pair = represented_pair(first, second, points)

    def search(one: SpectralEmbedding, other: SpectralEmbedding) -> Distance:
        most = search_limit(one, other) if limit is None else limit
        found = spectral_distance(one, other, limit=most, progress=progress)
        alike = mirror_images(one, other, found) if one is first and other is second else ()
        return replace(found, notes=found.notes + _clusters(one, other) + alike)

    found = distance_of_pair(pair, (first_part, second_part), search)
    correspondence = np.full(second_part.whole_count, -1, dtype=np.int64)
    correspondence[second_part.vertices] = first_part.vertices[found.correspondence]
    moved = second_part.extend(found.target_points)
    return replace(
        found, source_points=first_part.extend(found.source_points), target_points=moved, correspondence=correspondence
    )


def represented_pair(
    first: SpectralEmbedding, second: SpectralEmbedding, points: int | None = None
) -> tuple[Represented, Represented]:
    """Return two embeddings with the points that stand for them; all do where there are few."""
    if points is None:
        sizes = len(first.points), len(second.points)
        points = max(sizes) if sizes[0] * sizes[1] <= LARGEST_PAIR else REPRESENTATIVES
    return represented(first, points), represented(second, points)


def distance_of_pair(
    pair: tuple[Represented, Represented],
    parts: tuple[SurfacePart, SurfacePart],
    search: Callable[[SpectralEmbedding, SpectralEmbedding], Distance],
) -> Distance:
    """Return the distance that a search on representatives finds, of all vertices."""
    if all(len(one.rows) == len(one.whole.points) for one in pair):
        return search(pair[0].whole, pair[1].whole)
    return distance_by_representatives(*pair, (_edges(parts[0]), _edges(parts[1])), search)


def _edges(part: SurfacePart) -> csr_array:
    edges, count = part.mesh.edges, len(part.vertices)
    ones = np.ones(2 * len(edges), np.int8)
    return csr_array((ones, np.concatenate([edges, edges[:, ::-1]]).T), shape=(count, count))


def _clusters(first: SpectralEmbedding, second: SpectralEmbedding) -> tuple[str, ...]:
    """Say which modes have no basis of their own, so that the distance hangs on that which the solver gave."""
    blocks = eigenvalue_blocks(first.values, second.values, gap=SMALLEST_GAP)
    equal = [f"{start + 1} to {stop}" for start, stop in blocks if stop - start > 1]
    if not equal:
        return ()
    return (
        f"Modes {', '.join(equal)} have equal eigenvalues, and any rotation of them is as good: the distance depends on the one "
        "that the solver gave, and is proved least over signs alone; sx.align rotates them.",
    )


def mirror_images(first: SpectralEmbedding, second: SpectralEmbedding, found: Distance) -> tuple[str, ...]:
    """Say how many other choices of signs, of those that a beam search on samples finds, give the same distance."""
    scale = float(np.average(np.linalg.norm(first.points, axis=1), weights=first.weights))
    same = (1.0 + SAME_DISTANCE) * found.value + OF_A_POINT * scale
    signs, objective = np.diag(found.basis), HausdorffObjective(first, second)
    others = [other for other in competing_signs(first, second) if (other != signs).any()]
    count = sum(objective(other, same) <= same for other in others)
    if not count:
        return ()
    choices = "Another choice of signs gives" if count == 1 else f"At least {count} other choices of signs give"
    return (f"{choices} the same distance: a surface has a symmetry, and nothing intrinsic tells which map is right.",)


def search_limit(first: SpectralEmbedding, second: SpectralEmbedding) -> int:
    """Return how many evaluations a search may take that nobody has limited; one compares all pairs of points."""
    pairs = len(first.points) * len(second.points)
    return int(min(max(LARGEST_SEARCH / pairs, FEWEST), MOST))
