"""The spectral distance where eigenvalues nearly coincide: orthogonal blocks in place of signs, aligned in stages."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.distance import Distance
from surfexp.embedding.eigenvalue_blocks import Blocks
from surfexp.embedding.functional_map import orthogonal_map, vertex_map
from surfexp.embedding.nearest import mutual_distances
from surfexp.embedding.spectral_embedding import SpectralEmbedding, check_pair

STAGE_ITERATIONS, LAST_ITERATIONS = 10, 40


def block_distance(
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    blocks: Blocks,
    starts: int = 8,
    samples: int = 1500,
    seed: int = 0,
) -> Distance:
    """Return the mean Hausdorff distance, minimised over orthogonal matrices on blocks of coordinates.

    Several random starts on samples, each block entering after those before it are aligned; the best is refined on all
    points. The lower bound compares the lengths of points in each block, which no orthogonal matrix changes.

    Parameters
    ----------
    source, target : SpectralEmbedding
    blocks : ranges (start, stop) that cover the coordinates
    starts : int
        Random matrices of the first block.
    samples : int
        Points of each surface in the search.
    seed : int
    """
    check_pair(source, target)
    if blocks[-1][1] != source.dimension or starts < 1:
        raise ValueError(
            f"blocks end at {blocks[-1][1]}, starts = {starts}; {source.dimension} and at least 1 are needed"
        )
    rng = np.random.default_rng(seed)
    few = source.sample(samples, 2 * seed), target.sample(samples, 2 * seed + 1)
    candidates = [_staged(*few, blocks, rng) for _ in range(starts)]
    values = [_value(*few, basis) for basis in candidates]
    rough = candidates[int(np.argmin(values))]
    options = [rough, _iterate(source, target, rough, blocks, source.dimension, STAGE_ITERATIONS)]
    scores = [_value(source, target, basis) for basis in options]
    value, basis = min(scores), options[int(np.argmin(scores))]
    lower = min(_block_lengths_bound(source, target, blocks), value)
    moved = target.points @ basis
    return Distance(
        value=value,
        lower_bound=lower,
        optimal=lower >= value,
        evaluations=starts + len(options),
        basis=basis,
        source_points=source.points,
        target_points=moved,
        correspondence=vertex_map(basis, source.points, target.points),
        method="mean Hausdorff over blocks",
        metrics={"blocks": float(len(blocks)), "largest_block": float(max(stop - start for start, stop in blocks))},
    )


def _staged(source: SpectralEmbedding, target: SpectralEmbedding, blocks: Blocks, rng: np.random.Generator) -> Floats:
    """An alignment from a random matrix on the first block; each further block starts from the map of those before."""
    basis = np.zeros((source.dimension, source.dimension))
    for number, (start, stop) in enumerate(blocks):
        if number == 0:
            basis[start:stop, start:stop] = np.linalg.qr(rng.normal(size=(stop - start, stop - start)))[0]
        else:
            rows = vertex_map(basis[:start, :start], source.points[:, :start], target.points[:, :start])
            _align(basis, source, target, rows, ((start, stop),))
        last = number == len(blocks) - 1
        basis = _iterate(
            source, target, basis, blocks[: number + 1], stop, LAST_ITERATIONS if last else STAGE_ITERATIONS
        )
    return basis


def _iterate(
    source: SpectralEmbedding, target: SpectralEmbedding, basis: Floats, blocks: Blocks, known: int, count: int
) -> Floats:
    basis, before = basis.copy(), None
    for _ in range(count):
        rows = vertex_map(basis[:known, :known], source.points[:, :known], target.points[:, :known])
        if before is not None and (rows == before).all():
            break
        before = rows
        _align(basis, source, target, rows, blocks)
    return basis


def _align(
    basis: Floats, source: SpectralEmbedding, target: SpectralEmbedding, rows: np.ndarray, blocks: Blocks
) -> None:
    """Set blocks of `basis`, in place, to the best orthogonal matrices for a map."""
    for start, stop in blocks:
        block = source.points[:, start:stop], target.points[:, start:stop]
        basis[start:stop, start:stop] = orthogonal_map(*block, target.weights, rows)


def _value(source: SpectralEmbedding, target: SpectralEmbedding, basis: Floats) -> float:
    forward, backward = mutual_distances(source.points, target.points @ basis)
    return max(float(forward @ source.weights), float(backward @ target.weights))


def _block_lengths_bound(source: SpectralEmbedding, target: SpectralEmbedding, blocks: Blocks) -> float:
    """Mean Hausdorff distance of the lengths in each block, which is at most that of the points in any basis."""
    lengths = (
        np.stack([np.linalg.norm(embedding.points[:, start:stop], axis=1) for start, stop in blocks], axis=1)
        for embedding in (source, target)
    )
    forward, backward = mutual_distances(*lengths)
    return max(float(forward @ source.weights), float(backward @ target.weights))
