"""Maps between two surfaces and how well they carry labels."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.distance import Distance
from surfexp.embedding.surface_map import (
    Pair,
    embedding_map,
    icp_map,
    mirrored_space_map,
    signature_map,
    vertex_index_map,
    zoomout_map,
)
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem

N = Annotated[int, Field(ge=1, le=200, description="number of eigenfunctions")]
Seed = Annotated[int, Field(ge=0, description="seed of the samples")]
Samples = Annotated[int, Field(ge=10, le=100000, description="points on which signs are searched, drawn by area")]


METRICS = {
    "forward": Metric("mean distance from the source to the target"),
    "backward": Metric("mean distance from the target to the source"),
    "hausdorff": Metric("largest distance either way"),
    "same_signs": Metric("1 where all searches found the same signs, else 0", better="higher"),
}


@register("distance", "embedding_map", metrics=METRICS, defaults_of=embedding_map)
def embedding_map_distance(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: N,
    seed: Seed,
    samples: Samples,
) -> Distance:
    """Nearest neighbours in the global point embedding, signs optimal on samples."""
    return embedding_map(Pair(source_surface, target_surface, source, target), n=n, seed=seed, samples=samples)


@register("distance", "spectral_icp", metrics=METRICS, defaults_of=icp_map)
def spectral_icp_distance(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: N,
    seed: Seed,
    samples: Samples,
    iterations: Annotated[int, Field(ge=1, le=1000, description="most iterations")],
) -> Distance:
    """Spectral ICP: nearest neighbours and the best orthogonal matrix in turn, from the optimal signs."""
    return icp_map(
        Pair(source_surface, target_surface, source, target), n=n, seed=seed, samples=samples, iterations=iterations
    )


ZOOMOUT_METRICS = {
    **METRICS,
    "map_energy": Metric("how far the map is from commuting with the Laplacian", better="lower"),
    "rival_energy": Metric("the same of the best other map that a symmetry suggests"),
    "ambiguous": Metric("1 where a rival is about as good, else 0", better="lower"),
}


@register("distance", "zoomout", metrics=ZOOMOUT_METRICS, defaults_of=zoomout_map)
def zoomout_distance(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: N,
    seed: Seed,
    last: Annotated[int, Field(ge=2, le=2000, description="largest functional map")],
    step: Annotated[int, Field(ge=1, le=100, description="growth of the functional map")],
    samples: Annotated[
        int, Field(ge=10, le=100000, description="vertices of the target that take part before the last step")
    ],
    field: Annotated[str, Field(description="scalar map on both surfaces, used in a last refinement")],
    field_modes: Annotated[int, Field(ge=2, le=2000, description="size of the functional map of the last refinement")],
) -> Distance:
    """ZoomOut: functional maps of growing size, from the optimal signs; with a field, a last refinement by it."""
    return zoomout_map(
        Pair(source_surface, target_surface, source, target),
        n=n,
        seed=seed,
        last=last,
        step=step,
        samples=samples,
        field=field,
        field_modes=field_modes,
    )


@register("distance", "heat_kernel_signature", metrics=METRICS, defaults_of=signature_map)
def heat_kernel_signature_distance(
    source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem, *, n: N, seed: Seed
) -> Distance:
    """Nearest neighbours in the heat kernel signature, for comparison."""
    return signature_map(Pair(source_surface, target_surface, source, target), "heat", n=n, seed=seed)


@register("distance", "wave_kernel_signature", metrics=METRICS, defaults_of=signature_map)
def wave_kernel_signature_distance(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: N,
    seed: Seed,
    energies: Annotated[int, Field(ge=2, le=10000, description="number of energies")],
    width: Annotated[float, Field(gt=0, le=1000, description="width of a band in steps between energies")],
) -> Distance:
    """Nearest neighbours in the wave kernel signature, for comparison."""
    return signature_map(
        Pair(source_surface, target_surface, source, target), "wave", n=n, seed=seed, energies=energies, width=width
    )


@register("distance", "mirrored_space", metrics=METRICS, defaults_of=mirrored_space_map)
def mirrored_space_distance(
    source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem, *, n: N, seed: Seed
) -> Distance:
    """Nearest neighbours in space after mirroring in x: needs the pose, which the other methods do not."""
    return mirrored_space_map(Pair(source_surface, target_surface, source, target), n=n, seed=seed)


@register("distance", "vertex_index", metrics=METRICS, defaults_of=vertex_index_map)
def vertex_index_distance(
    source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem, *, n: N, seed: Seed
) -> Distance:
    """Vertex i to vertex i: a control that must score as chance does on shuffled vertices."""
    return vertex_index_map(Pair(source_surface, target_surface, source, target), n=n, seed=seed)
