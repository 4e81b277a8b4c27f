"""Maps between two surfaces and how well they carry labels."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.surface_map import (
    embedding_map,
    icp_map,
    mirrored_space_map,
    signature_map,
    vertex_index_map,
    zoomout_map,
)
from surfexp.lab.registry.registry import register

METRICS = {
    "forward": Metric("mean distance from the source to the target"),
    "backward": Metric("mean distance from the target to the source"),
    "hausdorff": Metric("largest distance either way"),
    "same_signs": Metric("1 where all searches found the same signs, else 0", better="higher"),
}
ZOOMOUT_METRICS = {
    **METRICS,
    "map_energy": Metric("how far the map is from commuting with the Laplacian", better="lower"),
    "rival_energy": Metric("the same of the best other map that a symmetry suggests"),
    "ambiguous": Metric("1 where a rival is about as good, else 0", better="lower"),
}
N = Field(ge=1, le=200, description="number of eigenfunctions")
SEED = Field(ge=0, description="seed of the samples")
SAMPLES = Field(ge=10, le=100000, description="points on which signs are searched, drawn by area")

register(
    "distance",
    "embedding_map",
    summary="Nearest neighbours in the global point embedding, signs optimal on samples.",
    options={"n": N, "samples": SAMPLES, "seed": SEED},
    metrics=METRICS,
)(embedding_map)

register(
    "distance",
    "spectral_icp",
    summary="Spectral ICP: nearest neighbours and the best orthogonal matrix in turn, from the optimal signs.",
    options={
        "n": N,
        "samples": SAMPLES,
        "seed": SEED,
        "iterations": Field(ge=1, le=1000, description="most iterations"),
    },
    metrics=METRICS,
)(icp_map)

register(
    "distance",
    "zoomout",
    summary="ZoomOut: functional maps of growing size, from the optimal signs; with a field, a last refinement by it.",
    options={
        "n": N,
        "last": Field(ge=2, le=2000, description="largest functional map"),
        "step": Field(ge=1, le=100, description="growth of the functional map"),
        "samples": Field(ge=10, le=100000, description="vertices of the target that take part before the last step"),
        "seed": SEED,
        "field": Field(description="scalar map on both surfaces, used in a last refinement"),
        "field_modes": Field(ge=2, le=2000, description="size of the functional map of the last refinement"),
    },
    metrics=ZOOMOUT_METRICS,
)(zoomout_map)

register(
    "distance",
    "heat_kernel_signature",
    summary="Nearest neighbours in the heat kernel signature, for comparison.",
    given={"signature": "heat"},
    options={"n": N, "seed": SEED},
    metrics=METRICS,
)(signature_map)

register(
    "distance",
    "wave_kernel_signature",
    summary="Nearest neighbours in the wave kernel signature, for comparison.",
    given={"signature": "wave"},
    options={
        "n": N,
        "seed": SEED,
        "energies": Field(ge=2, le=10000, description="number of energies"),
        "width": Field(gt=0, le=1000, description="width of a band in steps between energies"),
    },
    metrics=METRICS,
)(signature_map)

register(
    "distance",
    "mirrored_space",
    summary="Nearest neighbours in space after mirroring in x: needs the pose, which the other methods do not.",
    options={"n": N, "seed": SEED},
    metrics=METRICS,
)(mirrored_space_map)

register(
    "distance",
    "vertex_index",
    summary="Vertex i to vertex i: a control that must score as chance does on shuffled vertices.",
    options={"n": N, "seed": SEED},
    metrics=METRICS,
)(vertex_index_map)
