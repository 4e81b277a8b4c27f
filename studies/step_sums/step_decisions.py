"""Decisions of tests by the exact enhancement and by sums over steps, on data sets of known effect."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.inference.cluster_enhancement import enhanced
from surfexp.inference.corrections import family_wise
from surfexp.inference.linear_model import ContrastModel, contrast_model
from surfexp.inference.permutation_inference import BATCH
from surfexp.inference.rearrangements import Rearrangements, sign_flips, unchanged
from surfexp.inference.vertex_graph import VertexGraph, vertex_graph
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.geodesic_distance import geodesic_distance
from surfexp.statistics.resampling import exact_interval
from surfexp.statistics.statistic import Statistic

Flags = NDArray[np.bool_]
LEVEL, BOOTSTRAPS, CENTRAL = 0.05, 2000, (2.5, 97.5)
# steps of the threshold; a share is one of the largest |t| of each map
STEPS = {"step_1": 0.1, "step_2": 0.2, "step_5": 0.5}
SHARES = {"hundredth": 0.01, "twentieth": 0.05}
METHODS = ("exact", *STEPS, *SHARES)


@dataclass(frozen=True)
class Effect:
    """What is planted in each data set.

    Parameters
    ----------
    maps : int
        Maps of a data set.
    radius : float
        Of the geodesic disk, in the unit of the surface.
    height : float
        Constant in the disk, in deviations of the fields; 0 is no effect.
    flips : int
        Sign flips, the unchanged one among them.
    seed : int
        Of the middles of disks and of the flips.
    """

    maps: int = 16
    radius: float = 16.0
    height: float = 0.0
    flips: int = 500
    seed: int = 0


def enhanced_by(method: str, t: Floats, graph: VertexGraph) -> Floats:
    """Return the enhancement of a map of t by one of the methods.

    Parameters
    ----------
    method : str
        One of METHODS.
    t : (n,) float64
    graph : VertexGraph

    Returns
    -------
    (n,) float64
    """
    step = SHARES[method] * float(np.abs(t).max()) if method in SHARES else STEPS.get(method)
    return enhanced(t, graph, step=step)


def named_vertices(model: ContrastModel, chosen: Rearrangements, graph: VertexGraph) -> Flags:
    """Return which vertices have a family-wise p of at most 5 % by each method.

    Parameters
    ----------
    model : ContrastModel
    chosen : Rearrangements
    graph : VertexGraph

    Returns
    -------
    (m, n) bool
        A row for each of METHODS.
    """
    observed = model.t_maps(unchanged(len(model.direction)))[0]
    largest = np.array(
        [
            [np.abs(enhanced_by(method, t, graph)).max() for method in METHODS]
            for start in range(0, len(chosen), BATCH)
            for t in model.t_maps(chosen.part(start, start + BATCH))
        ]
    )
    return np.array(
        [
            family_wise(np.abs(enhanced_by(method, observed, graph)), column) <= LEVEL
            for method, column in zip(METHODS, largest.T, strict=True)
        ]
    )


def disagreements(named: Flags) -> Floats:
    """Return for each method the share of vertices that only it or only the exact one names, of those that either does.

    Parameters
    ----------
    named : (m, n) bool
        The exact method first.

    Returns
    -------
    (m,) float64
        NaN where neither names one.
    """
    either, only = (named | named[0]).sum(axis=1), (named ^ named[0]).sum(axis=1)
    return np.divide(only, either, out=np.full(len(named), np.nan), where=either > 0)


def step_decisions(mesh: TriangleMesh, fields: Floats, effect: Effect) -> Statistic:
    """Test data sets by the exact enhancement and by sums over steps.

    Parameters
    ----------
    mesh : TriangleMesh
    fields : (n, c) float64
        Independent; each run of `effect.maps` columns is a data set.
    effect : Effect

    Returns
    -------
    Statistic
        Rows: METHODS. Columns, in per cent with the ends of 95 % intervals: rejections (data sets that name a vertex),
        power (that name one of the disk; NaN without effect), disagreement with the exact method.

    Raises
    ------
    ValueError
        If the fields are no whole number of data sets, at least 2.
    """
    count = fields.shape[1] if fields.ndim == 2 else 1
    sets, rest = divmod(count, effect.maps)
    if rest or sets < 2:
        raise ValueError(f"{count} fields are no whole number of sets of {effect.maps}, at least 2 are needed")
    graph, random = vertex_graph(mesh), np.random.default_rng(effect.seed)
    rejected, hit, apart = [], [], []
    for data in np.split(fields.T, sets):
        middle = int(random.integers(len(mesh.vertices)))
        disk = geodesic_distance(mesh, np.array([middle])) <= effect.radius
        model = contrast_model(data + effect.height * disk, np.ones((effect.maps, 1)), np.ones(1))
        named = named_vertices(model, sign_flips(np.arange(effect.maps), effect.flips, random), graph)
        rejected.append(named.any(axis=1))
        hit.append(named[:, disk].any(axis=1))
        apart.append(disagreements(named))
    columns = {
        "rejections": _shares(np.array(rejected)),
        "power": _shares(np.array(hit)) if effect.height else np.full((len(METHODS), 3), np.nan),
        "disagreement": _means(np.array(apart)),
    }
    metrics = {"sets": float(sets)}
    for name, values in columns.items():
        for method, row in zip(METHODS, values.tolist(), strict=True):
            for word, value in zip((name, f"{name}_low", f"{name}_high"), row, strict=True):
                if np.isfinite(value):
                    metrics[f"{word} {method}"] = value
    rejections = zip(METHODS, columns["rejections"].tolist(), strict=True)
    if not effect.height:
        held = {method: float(low <= 100.0 * LEVEL <= high) for method, (_, low, high) in rejections}
        metrics |= {f"level_held {method}": value for method, value in held.items()}
    else:
        best = metrics["power exact"]
        metrics |= {f"power_lost {method}": best - metrics[f"power {method}"] for method in METHODS}
    return Statistic("decisions by enhancement", columns, METHODS, metrics)


def _shares(found: Flags) -> Floats:
    """Per cent of data sets, with Clopper and Pearson's interval."""
    hits = found.sum(axis=0).tolist()
    return np.array(
        [[100.0 * count / len(found), *(100.0 * end for end in exact_interval(count, len(found)))] for count in hits]
    )


def _means(found: Floats) -> Floats:
    """Mean in per cent over data sets with a value, with an interval by bootstrap over them."""
    random, rows = np.random.default_rng(0), []
    for column in found.T:
        known = column[np.isfinite(column)]
        if not len(known):
            rows.append([np.nan] * 3)
            continue
        drawn = random.choice(known, (BOOTSTRAPS, len(known))).mean(axis=1)
        rows.append([100.0 * known.mean(), *(100.0 * np.percentile(drawn, CENTRAL))])
    return np.array(rows)
