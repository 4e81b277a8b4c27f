"""The spectral distance of surfaces with nearly equal eigenvalues."""

from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.block_alignment import block_distance
from surfexp.embedding.distance import Distance
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks, size_at_gap
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem

METRICS = {
    "forward": Metric("mean distance from the source to the target"),
    "backward": Metric("mean distance from the target to the source"),
    "hausdorff": Metric("largest distance either way"),
    "same_signs": Metric("1 where all searches found the same signs, else 0", better="higher"),
    "blocks": Metric("blocks of nearly equal eigenvalues"),
    "largest_block": Metric("eigenfunctions of the largest block"),
    "eigenfunctions": Metric("eigenfunctions that are compared"),
}


@register(
    "distance", "block_orthogonal", metrics=METRICS, defaults_of=(size_at_gap, block_distance, spectral_embedding)
)
def block_orthogonal_distance(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: Annotated[int, Field(ge=1, le=200, description="number of eigenfunctions, moved to the nearest gap")] = 15,
    weighting: Annotated[
        Literal["global_point", "biharmonic", "heat_kernel", "diffusion"],
        Field(description="weight of each eigenfunction: (6.4), 1/lambda, or (3.11)"),
    ],
    time: Annotated[float, Field(gt=0, le=100, description="time of heat kernel and diffusion, in units of the area")],
    gap: Annotated[
        float, Field(ge=0, lt=1, description="eigenvalues nearer than this, relatively, belong to one block")
    ],
    starts: Annotated[int, Field(ge=1, le=1000, description="random matrices from which the search begins")],
    samples: Annotated[int, Field(ge=10, le=100000, description="points of each surface in the search, drawn by area")],
    seed: Annotated[int, Field(ge=0, description="seed of starts and samples")],
) -> Distance:
    """Spectral distance over orthogonal matrices on blocks of nearly equal eigenvalues, with a lower bound."""
    count = min(len(source.values), len(target.values)) - 1
    whole = tuple(
        spectral_embedding(system, surface.mesh.vertex_areas, count, weighting, time)
        for system, surface in ((source, source_surface), (target, target_surface))
    )
    size = size_at_gap(n, *(embedding.values for embedding in whole), gap=gap)
    pair = tuple(embedding.truncated(size) for embedding in whole)
    blocks = eigenvalue_blocks(*(embedding.values for embedding in pair), gap=gap)
    result = block_distance(*pair, blocks, starts, samples, seed)
    note = f"n = {n} would cut a block of nearly equal eigenvalues: {size} taken."
    notes = (note,) if size != n else ()
    return replace(result, metrics={**result.metrics, "eigenfunctions": float(size)}, notes=notes)
