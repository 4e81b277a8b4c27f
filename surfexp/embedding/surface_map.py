"""Maps between two surfaces by several methods, each as a `Distance` with its correspondence and how good it is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.distance import Distance
from surfexp.embedding.functional_map import spectral_icp, vertex_map
from surfexp.embedding.labels import map_metrics
from surfexp.embedding.nearest import mutual_distances, nearest
from surfexp.embedding.rival_maps import INDISTINCT_SHARE, map_contest
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.embedding.zoomout import refine_with_field, zoomout
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.heat_kernel import heat_kernel_signature
from surfexp.spectrum.pointwise_signatures import wave_kernel_signature


@dataclass(frozen=True, eq=False)
class Pair:
    """Two surfaces with their eigenpairs."""

    source_surface: Surface
    target_surface: Surface
    source: EigenSystem
    target: EigenSystem

    @property
    def areas(self) -> tuple[Floats, Floats]:
        """Vertex areas of both."""
        return self.source_surface.mesh.vertex_areas, self.target_surface.mesh.vertex_areas

    def optimal(self, n: int, samples: int, seed: int) -> Distance:
        """The map in the embedding with the best signs on samples."""
        first, second = self.areas
        embeddings = spectral_embedding(self.source, first, n), spectral_embedding(self.target, second, n)
        return spectral_distance(*embeddings, samples=samples, seed=seed, exact=False)

    def scored(self, distance: Distance, rows: Integers, method: str, basis: Floats | None = None) -> Distance:
        """The distance with another map, and another basis if one is given, and the metrics of the map."""
        metrics = {**distance.metrics, **map_metrics(self.source_surface, self.target_surface, rows)}
        result = replace(distance, correspondence=rows, method=method, metrics=metrics)
        if basis is None:
            return result
        moved = distance.target_points @ distance.basis @ basis
        forward, backward = mutual_distances(distance.source_points, moved)
        first, second = (areas / areas.sum() for areas in self.areas)
        value = max(float(forward @ first), float(backward @ second))
        numbers = {"distance": value, "lower_bound": 0.0, "gap": value, "optimal": 0.0}
        return replace(
            result, value=value, lower_bound=0.0, optimal=False, basis=basis, target_points=moved,
            metrics={**metrics, **numbers},
        )  # fmt: skip


def embedding_map(pair: Pair, n: int = 10, samples: int = 1500, seed: int = 0) -> Distance:
    """Nearest neighbours in the global point embedding of optimal signs."""
    distance = pair.optimal(n, samples, seed)
    return pair.scored(distance, distance.correspondence, "nearest in the embedding")


def icp_map(pair: Pair, n: int = 20, samples: int = 1500, seed: int = 0, iterations: int = 30) -> Distance:
    """Spectral ICP from the optimal signs."""
    distance = pair.optimal(n, samples, seed)
    first, second = pair.areas
    embeddings = spectral_embedding(pair.source, first, n), spectral_embedding(pair.target, second, n)
    rows, basis = spectral_icp(*embeddings, distance.basis, iterations)
    return pair.scored(distance, rows, "spectral ICP", basis)


def zoomout_map(
    pair: Pair,
    n: int = 10,
    last: int = 120,
    step: int = 2,
    samples: int = 800,
    seed: int = 0,
    field: str = "",
    field_modes: int = 60,
) -> Distance:
    """ZoomOut from the embedding of optimal signs; `field` names a scalar map that both have, for a last refinement."""
    distance = contested(pair, pair.optimal(n, min(samples, 1500), seed), n, seed)
    rows = zoomout(
        pair.source, pair.target, pair.areas, distance.correspondence, min(n, last), last, step, samples, seed
    )
    if not field:
        return pair.scored(distance, rows, "ZoomOut")
    for surface in (pair.source_surface, pair.target_surface):
        if field not in surface.scalars:
            known = ", ".join(surface.scalars) or "none"
            raise ValueError(f"scalar map {field!r} is not on {surface.name}; it has: {known}")
    fields = pair.source_surface.scalars[field], pair.target_surface.scalars[field]
    rows = refine_with_field(pair.source, pair.target, pair.areas, rows, fields, field_modes)
    return pair.scored(distance, rows, f"ZoomOut with {field}")


def contested(pair: Pair, distance: Distance, n: int, seed: int = 0) -> Distance:
    """The distance with the energies of its map and of the best other one, and a note where they hardly differ.

    Where other signs lead to a map of clearly less energy, the distance and the map are those of these signs.
    """
    first, second = pair.areas
    embeddings = spectral_embedding(pair.source, first, n), spectral_embedding(pair.target, second, n)
    contest = map_contest(
        (pair.source, pair.target), pair.areas, embeddings, np.diag(distance.basis).astype(np.int8), seed
    )
    found, rival, notes = contest.found, contest.rival, distance.notes
    if rival is None:
        return replace(distance, metrics={**distance.metrics, "map_energy": found.energy, "ambiguous": 0.0})
    if contest.rival_wins:
        notes += (
            f"The signs of least distance lead to a map of energy {found.energy:.3g}, others to {rival.energy:.3g}: "
            "the map is that of the others.",
        )
        found, rival = rival, found
        basis = np.diag(found.signs.astype(np.float64))
        distance = pair.scored(distance, vertex_map(basis, *(e.points for e in embeddings)), distance.method, basis)
    if contest.indistinct:
        notes += (
            f"Ambiguous: another map has the energy {rival.energy:.3g}, this one {found.energy:.3g}, less than "
            f"{100 * INDISTINCT_SHARE:.0f} % apart; "
            "what an isometry keeps cannot tell which is right, as with left and right of a body.",
        )
    energies = {
        "map_energy": found.energy,
        "rival_energy": rival.energy,
        "ambiguous": float(contest.indistinct),
    }
    return replace(distance, metrics={**distance.metrics, **energies}, notes=notes)


def signature_map(
    pair: Pair,
    signature: Literal["heat", "wave"] = "heat",
    n: int = 10,
    seed: int = 0,
    energies: int = 100,
    width: float = 7.0,
) -> Distance:
    """Nearest neighbours in the heat or wave kernel signature, on surfaces scaled to area 1.

    `energies` and `width` are those of `wave_kernel_signature`: a band is `width` steps between energies wide.
    """
    features = []
    for system, areas in zip((pair.source, pair.target), pair.areas, strict=True):
        area = float(areas.sum())
        scaled = replace(system, values=system.values * area, vectors=system.vectors * np.sqrt(area))
        if signature == "wave":
            features.append(wave_kernel_signature(scaled, energies, width))
        else:
            heat = heat_kernel_signature(scaled, np.geomspace(1e-3, 0.1, 30))
            features.append(heat / (heat * (areas / area)[:, None]).sum(axis=0))
    return pair.scored(
        pair.optimal(n, 1500, seed), nearest(features[1], features[0])[0], f"{signature} kernel signature"
    )


def mirrored_space_map(pair: Pair, n: int = 10, seed: int = 0) -> Distance:
    """Nearest neighbours in space after mirroring the target in x and centring both: for surfaces of known pose."""
    first, second = (
        surface.mesh.vertices - areas @ surface.mesh.vertices / areas.sum()
        for surface, areas in zip((pair.source_surface, pair.target_surface), pair.areas, strict=True)
    )
    rows = nearest(second * [-1.0, 1.0, 1.0], first)[0]
    return pair.scored(pair.optimal(n, 1500, seed), rows, "mirrored in space")


def vertex_index_map(pair: Pair, n: int = 10, seed: int = 0) -> Distance:
    """Vertex i to vertex i, the control: on shuffled vertices it must score what chance does."""
    rows = np.arange(len(pair.areas[1])) % len(pair.areas[0])
    return pair.scored(pair.optimal(n, 1500, seed), rows, "vertex index")
