"""The spectral distance of surfaces with nearly equal eigenvalues."""

from dataclasses import replace
from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.block_alignment import block_distance
from surfexp.embedding.distance import Distance
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks, size_at_gap
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem


class BlockOrthogonal(Options):
    """Blocks and starts."""

    n: int = Field(15, ge=1, le=200, description="number of eigenfunctions, moved to the nearest gap")
    weighting: Literal["global_point", "biharmonic", "heat_kernel", "diffusion"] = Field(
        "global_point", description="weight of each eigenfunction: (6.4), 1/lambda, or (3.11)"
    )
    time: float = Field(0.02, gt=0, le=100, description="time of heat kernel and diffusion, in units of the area")
    gap: float = Field(0.03, ge=0, lt=1, description="eigenvalues nearer than this, relatively, belong to one block")
    starts: int = Field(8, ge=1, le=1000, description="random matrices from which the search begins")
    samples: int = Field(1500, ge=10, le=100000, description="points of each surface in the search, drawn by area")
    seed: int = Field(0, ge=0, description="seed of starts and samples")


METRICS = {
    "forward": Metric("mean distance from the source to the target"),
    "backward": Metric("mean distance from the target to the source"),
    "hausdorff": Metric("largest distance either way"),
    "same_signs": Metric("1 where all searches found the same signs, else 0", better="higher"),
    "blocks": Metric("blocks of nearly equal eigenvalues"),
    "largest_block": Metric("eigenfunctions of the largest block"),
    "eigenfunctions": Metric("eigenfunctions that are compared"),
}


@register("distance", "block_orthogonal", metrics=METRICS)
def block_orthogonal_distance(
    options: BlockOrthogonal,
    *,
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
) -> Distance:
    """Spectral distance over orthogonal matrices on blocks of nearly equal eigenvalues, with a lower bound."""
    count = min(len(source.values), len(target.values)) - 1
    whole = tuple(
        spectral_embedding(system, surface.mesh.vertex_areas, count, options.weighting, options.time)
        for system, surface in ((source, source_surface), (target, target_surface))
    )
    n = size_at_gap(options.n, *(embedding.values for embedding in whole), gap=options.gap)
    pair = tuple(embedding.truncated(n) for embedding in whole)
    blocks = eigenvalue_blocks(*(embedding.values for embedding in pair), gap=options.gap)
    result = block_distance(*pair, blocks, options.starts, options.samples, options.seed)
    note = f"n = {options.n} would cut a block of nearly equal eigenvalues: {n} taken."
    notes = (note,) if n != options.n else ()
    return replace(result, metrics={**result.metrics, "eigenfunctions": float(n)}, notes=notes)
