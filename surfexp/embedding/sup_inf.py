"""The sup-inf of (6.9) over orthogonal blocks, which surfaces of different multiplicities need to obey the triangle."""

from __future__ import annotations

from itertools import product

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.eigenvalue_blocks import Blocks
from surfexp.embedding.mean_hausdorff import Summary
from surfexp.embedding.nearest import mutual_distances
from surfexp.embedding.spectral_embedding import SpectralEmbedding, check_pair


def block_group(blocks: Blocks, angles: int = 24, seed: int = 0, limit: int = 20_000) -> list[Floats]:
    """Return orthogonal matrices that fill the group of block-diagonal ones: signs, angles of planes, random beyond.

    Parameters
    ----------
    blocks : ranges (start, stop) that cover the coordinates
    angles : int
        Turns of a plane, evenly from 0, each with and without reflection; random matrices of a larger block.
    limit : int
        Most matrices.

    Raises
    ------
    ValueError
        If there would be more.
    """
    rng, parts = np.random.default_rng(seed), []
    for start, stop in blocks:
        size = stop - start
        if size == 1:
            parts.append([np.eye(1), -np.eye(1)])
        elif size == 2:
            turns = 2.0 * np.pi * np.arange(angles) / angles
            plane = [np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]]) for t in turns]
            parts.append([matrix @ np.diag([1.0, mirror]) for matrix in plane for mirror in (1.0, -1.0)])
        else:
            drawn = [np.linalg.qr(rng.normal(size=(size, size)))[0] for _ in range(angles)]
            parts.append([np.eye(size), *drawn])
    count = int(np.prod([len(part) for part in parts]))
    if count > limit:
        raise ValueError(
            f"{count} matrices for blocks {blocks}: take fewer angles, or n so that there are at most {limit}"
        )
    matrices = []
    for choice in product(*parts):
        matrix = np.zeros((blocks[-1][1], blocks[-1][1]))
        for (start, stop), part in zip(blocks, choice, strict=True):
            matrix[start:stop, start:stop] = part
        matrices.append(matrix)
    return matrices


def refines(fine: Blocks, coarse: Blocks) -> bool:
    """Whether every block of `fine` lies inside one of `coarse`, so that its group is a part of the other's."""
    return all(any(a <= start and stop <= b for a, b in coarse) for start, stop in fine)


def sup_inf_distance(
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    source_blocks: Blocks,
    target_blocks: Blocks,
    summary: Summary = "largest",
    angles: int = 24,
    seed: int = 0,
) -> float:
    """Return the larger of sup over the one surface's bases of inf over the other's, both ways (6.9), on grids of bases.

    With the Hausdorff distance inside ("largest", both directions) this is the Hausdorff distance between two orbits, a
    pseudo-metric up to the width of the grid. With "mean" the integrals are those published, and it is not.

    Parameters
    ----------
    source, target : SpectralEmbedding
        A few hundred points each; every pair of bases costs one comparison.
    source_blocks, target_blocks : ranges (start, stop)
        Eigenvalues of multiplicity more than one, of each surface by itself.
    """
    check_pair(source, target)
    groups = [block_group(blocks, angles, seed) for blocks in (source_blocks, target_blocks)]
    # turning both at once changes nothing, so a sup over a subgroup of the other's bases needs one member
    outer = [
        group[:1] if refines(own, other) else group
        for group, own, other in zip(
            groups, (source_blocks, target_blocks), (target_blocks, source_blocks), strict=True
        )
    ]
    value = 0.0
    for turned, others, is_source in ((outer[0], groups[1], True), (outer[1], groups[0], False)):
        for basis in turned:
            least = np.inf
            for other in others:
                first, second = (basis, other) if is_source else (other, basis)
                forward, backward = mutual_distances(source.points @ first, target.points @ second)
                if summary == "largest":
                    found = max(float(forward.max()), float(backward.max()))
                else:
                    found = float(forward @ source.weights) if is_source else float(backward @ target.weights)
                least = min(least, found)
            value = max(value, least)
    return value
