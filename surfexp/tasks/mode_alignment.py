"""How the modes of two surfaces correspond."""

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
from surfexp.embedding.sign_search import Progress
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, Weighting, mode_weights
from surfexp.mesh.given_numbers import one_of, real_number, whole_number
from surfexp.tasks.distances import distance_of_pair, mirror_images, represented_pair, search_limit
from surfexp.tasks.embedded_surface import embedded
from surfexp.tasks.given_surface import SurfaceLike


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
    points: int | None = None,
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
    points : int, optional
        How many vertices of each surface stand for the others; default as in `distance`.
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
    points = None if points is None else whole_number(points, "points", 1)
    (longer, whole), (other, part) = (embedded(one, count, weighting, name="count", more=1) for one in (source, target))
    notes = _cut_block(eigenvalue_blocks(longer.values, other.values, gap=relative_gap))
    first, second = longer.truncated(count), other.truncated(count)
    blocks = eigenvalue_blocks(first.values, second.values, gap=relative_gap)

    def search(one: SpectralEmbedding, another: SpectralEmbedding) -> Distance:
        if len(blocks) < count:
            return block_distance(one, another, blocks)
        most = search_limit(one, another) if limit is None else limit
        found = spectral_distance(one, another, limit=most, progress=progress)
        alike = mirror_images(one, another, found) if one is first and another is second else ()
        return replace(found, notes=found.notes + alike)

    found = distance_of_pair(represented_pair(first, second, points), (whole, part), search)
    lengths = np.sqrt(part.mesh.area) * np.asarray(mode_weights(second.values, weighting))
    vectors = part.extend(second.points / lengths @ found.basis)
    numbered = tuple((start + 1, stop) for start, stop in blocks)
    return ModeAlignment(
        found.basis, numbered, found.value, found.lower_bound, found.optimal, vectors, notes + found.notes
    )


def _cut_block(blocks: Blocks) -> tuple[str, ...]:
    """Say it where the last mode is no last one: blocks of one mode more than was asked for."""
    start, stop = blocks[-1]
    if stop - start == 1:
        return ()
    choice = f"; {start} modes end between two" if start else ""
    return (f"Mode {stop} lies too near to mode {stop - 1} to be told from it: the last block is cut{choice}.",)
