"""Maps between two surfaces and how well they carry labels."""

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
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem


class Start(Options):
    """The embedding from which a map begins."""

    n: int = Field(10, ge=1, le=200, description="number of eigenfunctions")
    seed: int = Field(0, ge=0, description="seed of the samples")


class Sampled(Start):
    """The same on samples."""

    samples: int = Field(1500, ge=10, le=100000, description="points on which signs are searched, drawn by area")


class Icp(Sampled):
    """Spectral ICP."""

    n: int = Field(20, ge=1, le=200, description="number of eigenfunctions")
    iterations: int = Field(30, ge=1, le=1000, description="most iterations")


class Zoomout(Start):
    """ZoomOut."""

    last: int = Field(120, ge=2, le=2000, description="largest functional map")
    step: int = Field(2, ge=1, le=100, description="growth of the functional map")
    samples: int = Field(
        800, ge=10, le=100000, description="vertices of the target that take part before the last step"
    )
    field: str = Field("", description="scalar map on both surfaces, used in a last refinement")
    field_modes: int = Field(60, ge=2, le=2000, description="size of the functional map of the last refinement")


class Wave(Start):
    """Bands of energy."""

    energies: int = Field(100, ge=2, le=10000, description="number of energies")
    width: float = Field(7.0, gt=0, le=1000, description="width of a band in steps between energies")


METRICS = {
    "forward": Metric("mean distance from the source to the target"),
    "backward": Metric("mean distance from the target to the source"),
    "hausdorff": Metric("largest distance either way"),
    "same_signs": Metric("1 where all searches found the same signs, else 0", better="higher"),
}


@register("distance", "embedding_map", metrics=METRICS)
def embedding_map_distance(
    options: Sampled, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """Nearest neighbours in the global point embedding, signs optimal on samples."""
    return embedding_map(Pair(source_surface, target_surface, source, target), **dict(options))


@register("distance", "spectral_icp", metrics=METRICS)
def spectral_icp_distance(
    options: Icp, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """Spectral ICP: nearest neighbours and the best orthogonal matrix in turn, from the optimal signs."""
    return icp_map(Pair(source_surface, target_surface, source, target), **dict(options))


ZOOMOUT_METRICS = {
    **METRICS,
    "map_energy": Metric("how far the map is from commuting with the Laplacian", better="lower"),
    "rival_energy": Metric("the same of the best other map that a symmetry suggests"),
    "ambiguous": Metric("1 where a rival is about as good, else 0", better="lower"),
}


@register("distance", "zoomout", metrics=ZOOMOUT_METRICS)
def zoomout_distance(
    options: Zoomout, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """ZoomOut: functional maps of growing size, from the optimal signs; with a field, a last refinement by it."""
    return zoomout_map(Pair(source_surface, target_surface, source, target), **dict(options))


@register("distance", "heat_kernel_signature", metrics=METRICS)
def heat_kernel_signature_distance(
    options: Start, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """Nearest neighbours in the heat kernel signature, for comparison."""
    return signature_map(Pair(source_surface, target_surface, source, target), "heat", **dict(options))


@register("distance", "wave_kernel_signature", metrics=METRICS)
def wave_kernel_signature_distance(
    options: Wave, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """Nearest neighbours in the wave kernel signature, for comparison."""
    return signature_map(Pair(source_surface, target_surface, source, target), "wave", **dict(options))


@register("distance", "mirrored_space", metrics=METRICS)
def mirrored_space_distance(
    options: Start, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """Nearest neighbours in space after mirroring in x: needs the pose, which the other methods do not."""
    return mirrored_space_map(Pair(source_surface, target_surface, source, target), **dict(options))


@register("distance", "vertex_index", metrics=METRICS)
def vertex_index_distance(
    options: Start, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """Vertex i to vertex i: a control that must score as chance does on shuffled vertices."""
    return vertex_index_map(Pair(source_surface, target_surface, source, target), **dict(options))
