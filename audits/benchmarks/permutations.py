"""Ten thousand sign flips of twenty maps with threshold-free enhancement, and beside mne's sum over steps."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from importlib import import_module
from importlib.util import find_spec

import numpy as np
from scipy.sparse import csr_array

from audits.benchmarks.line import Line, not_installed, race, within
from audits.benchmarks.measurement import measure, measure_both
from audits.benchmarks.scenes import cortex_scene
from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.contract.arrays import Floats
from surfexp.inference.cluster_enhancement import enhanced
from surfexp.inference.linear_model import ContrastModel, contrast_model
from surfexp.inference.permutation_inference import NullDistributions, Statistics, null_distributions
from surfexp.inference.rearrangements import sign_flips, unchanged
from surfexp.inference.vertex_graph import VertexGraph, graph_of_edges
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

MAPS, COUNT, QUICK = 20, 10_000, 10
# flips of the race: the package takes seven in a second
RACED, STEP, LEAST = 50, 0.2, 10.0
# minutes on one core, at the vertices of both hemispheres of fsaverage5 and of fsLR-32k
SMALL_LIMIT, LARGE_LIMIT, LARGE = 120.0, 480.0, 32_492


def warm_up() -> None:
    """Compile what the lines use."""
    ball = icosphere(2).mesh
    ours(*_model(graph_of_edges(ball.edges, ball.vertex_areas)), 2)


def lines(quick: bool) -> list[Line]:
    """Return a line for the whole test, and one beside mne."""
    graph = two_cortices()
    found = [_whole(graph, QUICK if quick else COUNT, SMALL_LIMIT), _beside_mne(graph, _model(graph)[0], quick)]
    return found if quick else [*found, _whole(two_folded_cortices(), COUNT, LARGE_LIMIT)]


def _whole(graph: VertexGraph, count: int, seconds: float) -> Line:
    model, _ = _model(graph)
    work = f"{count:,} sign flips of {MAPS} maps, {len(graph.areas):,} vertices: max t, extent, mass, exact TFCE"
    found, cost = measure(partial(ours, model, graph, count), 1)
    least = float(found.largest["tfce"].min())
    return within(work, seconds, cost, f"least of the largest enhancements {least:.3g}", least > 0.0)


def two_cortices() -> VertexGraph:
    """Both hemispheres of fsaverage5 as one graph."""
    return _two([fsaverage5(side, "white").mesh for side in ("left", "right")])


def two_folded_cortices() -> VertexGraph:
    """Two folded surfaces of the number of vertices of fsLR-32k."""
    return _two([cortex_scene(LARGE).surface.mesh] * 2)


def _two(meshes: Sequence[TriangleMesh]) -> VertexGraph:
    shift = len(meshes[0].vertices)
    edges = np.concatenate([meshes[0].edges, meshes[1].edges + shift])
    return graph_of_edges(edges, np.concatenate([mesh.vertex_areas for mesh in meshes]))


def _model(graph: VertexGraph) -> tuple[ContrastModel, VertexGraph]:
    """Twenty maps of noise, smoothed by the mean of neighbours six times."""
    n = len(graph.areas)
    ring = csr_array((np.ones(len(graph.neighbours)), graph.neighbours, graph.starts), shape=(n, n))
    counts = np.diff(graph.starts) + 1.0
    maps = np.random.default_rng(0).standard_normal((n, MAPS))
    for _ in range(6):
        maps = (maps + ring @ maps) / counts[:, None]
    return contrast_model(maps.T, np.ones((MAPS, 1)), np.ones(1)), graph


def ours(model: ContrastModel, graph: VertexGraph, count: int) -> NullDistributions:
    """All four statistics of each flip."""
    chosen = sign_flips(np.arange(MAPS), count, np.random.default_rng(0))
    return null_distributions(model, chosen, Statistics(graph, 3.5))


def _beside_mne(graph: VertexGraph, model: ContrastModel, quick: bool) -> Line:
    count = QUICK if quick else RACED
    work, rival = f"{count} sign flips of {MAPS} maps, 20,484 vertices", f"mne, TFCE by steps of {STEP:g}"
    if find_spec("mne") is None:
        return not_installed(work, rival, LEAST, "mne")
    (_, cost), (theirs, their_cost) = measure_both(
        partial(ours, model, graph, count), partial(mne, model, graph, count)
    )
    plain = VertexGraph(graph.starts, graph.neighbours, np.ones(len(graph.areas)))
    exact = enhanced(model.t_maps(unchanged(MAPS))[0], plain, extent_power=0.5)
    error = float(np.abs(theirs - exact).max() / np.abs(exact).max())
    accuracy = f"error of a map of TFCE, by vertices, over its largest value: ours rounding, theirs {error:.1%}"
    return race(work, rival, LEAST, cost, their_cost, accuracy, note="Ours has three more statistics of each flip.")


def mne(model: ContrastModel, graph: VertexGraph, count: int) -> Floats:
    """Its documented call; the map of the data as they are."""
    n = len(graph.areas)
    ring = csr_array((np.ones(len(graph.neighbours)), graph.neighbours, graph.starts), shape=(n, n))
    found = import_module("mne.stats").permutation_cluster_1samp_test(
        model.residuals,
        threshold={"start": 0, "step": STEP},
        n_permutations=count,
        adjacency=ring,
        out_type="mask",
        seed=0,
        n_jobs=1,
        verbose="error",
    )
    return np.asarray(found[0])
