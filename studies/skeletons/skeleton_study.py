"""A group of patches studied by their Reeb skeletons: one weight, one choice of levels, and what comes of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.eigenmap import eigenmap
from surfexp.skeleton.flux import flux, flux_weights, weighted_operator
from surfexp.skeleton.level_selection import Choice, choose_levels
from surfexp.skeleton.polyline import distance_from_line, evenly_resampled, trunk_contours
from surfexp.skeleton.pruning import pruned
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import Skeleton
from surfexp.skeleton.skeleton_length import skeleton_lengths

from .agreement import topology
from .callosum_shape import GENU
from .midline import midline_errors
from .skeleton_alignment import align, bootstrap_shares, principal_components


def signed_eigenmap(
    mesh: TriangleMesh, alpha: float = 0.0, contrast: float = 1.0, ahead: Floats | None = None
) -> Floats:
    """(n,) first eigenmap of a patch, with the flux weights (5.10) unless alpha is 0, signed to rise ahead (by default with x)."""
    operator = fem(mesh)
    if alpha:
        weights = flux_weights(flux(mesh, boundary_distance(mesh)), alpha, contrast)
        operator = weighted_operator(operator, weights)
    values = eigenmap(operator).values
    place = mesh.vertices[:, 0] if ahead is None else mesh.vertices @ ahead
    rising = float((values * (place - place.mean()) * mesh.vertex_areas).sum())
    return values if rising >= 0 else -values


def eigenmap_skeleton(
    mesh: TriangleMesh,
    alpha: float = 0.0,
    contrast: float = 1.0,
    levels: Choice = "arc_length",
    count: int = 50,
    persistence: float = 0.01,
    name: str = "surface",
) -> tuple[Skeleton, Floats]:
    """Skeleton of a patch by its first eigenmap, and the eigenmap, signed to rise with x.

    Parameters
    ----------
    alpha, contrast : float
        Of the flux weights (5.10); the weight is 1 when alpha is 0.
    levels, count
        As in `choose_levels`.
    persistence : float
        As in `pruned`.
    """
    values = signed_eigenmap(mesh, alpha, contrast)
    skeleton = pruned(reeb_graph(mesh, values, choose_levels(mesh, values, count, levels), name), persistence)
    lengths = skeleton_lengths(mesh, values, skeleton)
    return replace(skeleton, metrics={**skeleton.metrics, **lengths}), values


def group_skeletons(
    surfaces: Mapping[str, Surface],
    alpha: float = 0.0,
    contrast: float = 1.0,
    levels: Choice = "arc_length",
    count: int = 50,
    persistence: float = 0.01,
) -> dict[str, Skeleton]:
    """`eigenmap_skeleton` of every member, by its label."""
    return {
        label: eigenmap_skeleton(surface.mesh, alpha, contrast, levels, count, persistence, surface.name)[0]
        for label, surface in surfaces.items()
    }


def topology_metrics(skeletons: Mapping[str, Skeleton]) -> dict[str, float]:
    """Share of chains, number of different topologies, and mean counts of leaves, branch nodes and loops."""
    found = np.array([topology(skeleton) for skeleton in skeletons.values()], dtype=float)
    return {
        "chains": float(np.mean([skeleton.is_chain for skeleton in skeletons.values()])),
        "topologies": float(len(np.unique(found, axis=0))),
        "leaves": float(found[:, 0].mean()),
        "branch_nodes": float(found[:, 1].mean()),
        "loops": float(found[:, 2].mean()),
        "members": float(len(found)),
    }


def miss_metrics(surfaces: Mapping[str, Surface], skeletons: Mapping[str, Skeleton]) -> dict[str, float]:
    """Mean and worst of the largest distance from the known midlines, in edge lengths; empty where none is known.

    "genu_miss" is the mean of the largest distance of the genu's part of the midline, where it turns back.
    """
    midlines = {
        label: surface.truth.midline for label, surface in surfaces.items() if surface.truth.midline is not None
    }
    if len(midlines) < len(surfaces):
        return {}
    errors = np.array(
        [_misses(midlines[label], skeletons[label]) / surface.mesh.edge_length for label, surface in surfaces.items()]
    )
    names = ("midline_miss", "skeleton_excess", "genu_miss")
    means = dict(zip(names, map(float, errors.mean(axis=0)), strict=True))
    return {**means, "midline_miss_worst": float(errors[:, 0].max())}


def _misses(midline: Floats, skeleton: Skeleton) -> Floats:
    line = trunk_contours(skeleton)
    first, last = (round(share * (len(midline) - 1)) for share in GENU)
    genu = float(distance_from_line(midline[first : last + 1], line)[0].max())
    return np.array([*midline_errors(midline, line), genu])


@dataclass(frozen=True, eq=False)
class Compactness:
    """Principal components of the skeletons of a group.

    Parameters
    ----------
    shares, variances : (r,) float64
    intervals : (r, 2) float64
        Bootstrap intervals of the shares.
    metrics : dict of str to float
    """

    shares: Floats
    variances: Floats
    intervals: Floats
    metrics: dict[str, float]


def compactness(
    skeletons: Mapping[str, Skeleton], resample: bool = False, scale: bool = False, draws: int = 200, seed: int = 0
) -> Compactness:
    """Align the trunks of a group and find their principal components (figure 5.10).

    Parameters
    ----------
    resample : bool
        Put points at equal arc length on every trunk first, so that a choice of levels is not credited with resampling.
    """
    lines = [trunk_contours(skeleton) for skeleton in skeletons.values()]
    count = max(len(line) for line in lines)
    even = [evenly_resampled(line, count) if resample or len(line) != count else line for line in lines]
    aligned = align(np.stack(even), scale)
    found, intervals = principal_components(aligned), bootstrap_shares(aligned, draws, seed=seed)
    covered = [item.metrics["polyline_length"] / item.metrics["mean_distance_length"] for item in skeletons.values()]
    metrics = {
        "first_share": float(found.shares[0]),
        "first_share_low": float(intervals[0, 0]),
        "first_share_high": float(intervals[0, 1]),
        "first_three_share": float(found.shares[:3].sum()),
        "total_variance": found.total_variance,
        "coverage": float(np.mean(covered)),
    }
    return Compactness(found.shares, found.variances, intervals, metrics)
