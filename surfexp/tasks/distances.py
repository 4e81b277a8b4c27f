"""Spectral distance of two surfaces, and how their modes correspond."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import get_args

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.embedding.block_alignment import block_distance
from surfexp.embedding.distance import Distance
from surfexp.embedding.eigenvalue_blocks import RELATIVE_GAP, Blocks, eigenvalue_blocks
from surfexp.embedding.mean_hausdorff import HausdorffObjective
from surfexp.embedding.rival_maps import competing_signs
from surfexp.embedding.sign_search import Progress
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, Weighting, mode_weights, spectral_embedding
from surfexp.mesh.given_numbers import one_of, real_number, whole_number
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.spectrum.eigensystem import SMALLEST_GAP, EigenSystem
from surfexp.spectrum.lowest_pairs import lowest_pairs
from surfexp.tasks.inputs import SurfaceLike, as_surface, part_for, require_connected

# pairs of points that a search compares at most where no limit is given: about a minute
LARGEST_SEARCH, FEWEST, MOST = 2e10, 100, 2000
# distances that differ by less, of themselves or of the mean length of a point, are the same up to rounding
SAME_DISTANCE, OF_A_POINT = 1e-5, 1e-6


def distance(
    source: SurfaceLike,
    target: SurfaceLike,
    n: int = 20,
    *,
    weighting: Weighting = "biharmonic",
    limit: int | None = None,
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
        pairs of points, in 100 to 2,000 evaluations: 400 for two surfaces of 7,000 vertices.
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
    (first, first_part), (second, second_part) = embedded(source, n, weighting), embedded(target, n, weighting)
    most = search_limit(first, second) if limit is None else limit
    found = spectral_distance(first, second, limit=most, progress=progress)
    found = replace(found, notes=found.notes + _clusters(first, second) + _mirror_images(first, second, found))
    correspondence = np.full(second_part.whole_count, -1, dtype=np.int64)
    correspondence[second_part.vertices] = first_part.vertices[found.correspondence]
    moved = second_part.extend(found.target_points)
    return replace(
        found, source_points=first_part.extend(found.source_points), target_points=moved, correspondence=correspondence
    )


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


def _mirror_images(first: SpectralEmbedding, second: SpectralEmbedding, found: Distance) -> tuple[str, ...]:
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


@dataclass(frozen=True, eq=False, repr=False)
class ModeAlignment(Drawable):
    """The combination of the target's modes that corresponds to each mode of the source.

    Parameters
    ----------
    basis : (n, n) float64
        Target modes times it correspond to source modes; orthogonal, zero between blocks.
    blocks : tuple of (int, int)
        Ranges of modes with nearly equal eigenvalues on either surface, counted from 1. Inside a block only the span is defined.
    value, lower_bound : float
        Spectral distance in this basis, and what no choice of signs can go below.
    optimal : bool
        Whether the bound proves the signs of single modes best.
    vectors : (t, n) float64
        The target's modes, aligned; NaN outside the mask.
    notes : tuple of str
    """

    basis: Floats
    blocks: tuple[tuple[int, int], ...]
    value: float
    lower_bound: float
    optimal: bool
    vectors: Floats
    notes: tuple[str, ...] = ()

    def _summary(self) -> Summary:
        facts = {
            "single modes": sum(first == last for first, last in self.blocks),
            "blocks of several": sum(first < last for first, last in self.blocks),
            "spectral distance": self.value,
            "lower bound": self.lower_bound,
            "signs proved best": self.optimal,
        }
        return Summary(f"{len(self.basis)} aligned modes", facts, self.notes)


def align(
    source: SurfaceLike,
    target: SurfaceLike,
    count: int = 50,
    *,
    weighting: Weighting = "biharmonic",
    relative_gap: float = RELATIVE_GAP,
    limit: int | None = None,
    progress: Progress | None = None,
) -> ModeAlignment:
    """Bring the modes of one surface into correspondence with those of another: signs, order and rotations in clusters.

    Modes whose eigenvalues differ by less than `relative_gap` on either surface may change places between the two. Such a
    block is rotated as a whole. Where no block has several modes, the best signs are found with a proof.

    Parameters
    ----------
    source, target : Surface, path, or (vertices, faces)
    count : int
        Number of modes after the constant.
    weighting : "biharmonic", "global_point", "heat_kernel" or "diffusion"
    relative_gap : float
    limit : int, optional
        Most evaluations of the search over signs; default as in `distance`.
    progress : callable, optional
        Called with the number of evaluations and the relative gap that is left, where all blocks are single.

    Returns
    -------
    ModeAlignment

    Raises
    ------
    ValueError
        If a mesh is unfit or too coarse for so many modes.

    Examples
    --------
    >>> import surfexp as sx
    >>> body = sx.shape("ellipsoid", levels=3)
    >>> sx.align(body, body, 5).basis.round(3).diagonal().tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0]
    """
    count = whole_number(count, "count", 1)
    limit = None if limit is None else whole_number(limit, "limit", 1)
    relative_gap = real_number(relative_gap, "relative_gap")
    one_of(weighting, "weighting", get_args(Weighting))
    (longer, _), (other, part) = (embedded(one, count, weighting, name="count", more=1) for one in (source, target))
    notes = _cut_block(eigenvalue_blocks(longer.values, other.values, gap=relative_gap))
    first, second = longer.truncated(count), other.truncated(count)
    blocks = eigenvalue_blocks(first.values, second.values, gap=relative_gap)
    single = len(blocks) == count
    most = search_limit(first, second) if limit is None else limit
    found = (
        spectral_distance(first, second, limit=most, progress=progress)
        if single
        else block_distance(first, second, blocks)
    )
    lengths = np.sqrt(part.mesh.area) * np.asarray(mode_weights(second.values, weighting))
    vectors = part.extend(second.points / lengths @ found.basis)
    numbered = tuple((start + 1, stop) for start, stop in blocks)
    notes += _mirror_images(first, second, found) if single else ()
    return ModeAlignment(
        found.basis, numbered, found.value, found.lower_bound, found.optimal, vectors, found.notes + notes
    )


def _cut_block(blocks: Blocks) -> tuple[str, ...]:
    """Say it where the last mode is no last one: blocks of one mode more than was asked for."""
    start, stop = blocks[-1]
    if stop - start == 1:
        return ()
    choice = f"; {start} modes end between two" if start else ""
    return (f"Mode {stop} lies too near to mode {stop - 1} to be told from it: the last block is cut{choice}.",)


def search_limit(first: SpectralEmbedding, second: SpectralEmbedding) -> int:
    """Return how many evaluations a search may take that nobody has limited; one compares all pairs of points."""
    pairs = len(first.points) * len(second.points)
    return int(min(max(LARGEST_SEARCH / pairs, FEWEST), MOST))


def embedded(
    given: SurfaceLike, n: int, weighting: Weighting, *, name: str = "n", more: int = 0
) -> tuple[SpectralEmbedding, SurfacePart]:
    """Return the embedding of a surface by `n + more` eigenfunctions, scaled to area 1, and the part inside its mask.

    `name` is what the user calls n.
    """
    embedding, _, part = embedded_pairs(given, n, weighting, name=name, more=more)
    return embedding, part


def embedded_pairs(
    given: SurfaceLike, n: int, weighting: Weighting, *, name: str = "n", more: int = 0
) -> tuple[SpectralEmbedding, EigenSystem, SurfacePart]:
    """Return the same with the eigenpairs behind it."""
    owner = as_surface(given)
    part = part_for(owner)
    require_connected(part, "spectral distances", both=owner.right is not None)
    n = whole_number(n, name, 1, len(part.vertices) - 1 - more) + more
    _, system = lowest_pairs(Surface(part.mesh, owner.name, owner.unit), n + 1)
    return spectral_embedding(system, part.mesh.vertex_areas, n, weighting), system, part
