"""Nodal count sequences of a spectrum: published, filtered, soft, or averaged over the bases of its clusters."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.nodal_domains import (
    cluster_averaged_counts,
    courant_violations,
    filtered_nodal_counts,
    nodal_counts,
    nodal_thresholds,
)
from surfexp.spectrum.nodal_graph import NodalGraph
from surfexp.spectrum.soft_nodal_counts import soft_nodal_counts

Counting = Literal["raw", "filtered", "soft", "averaged"]
COUNTINGS = ("raw", "filtered", "soft", "averaged")
NODES_PER_MODE = 100


def trusted_modes(node_count: int) -> int:
    """Return up to which mode nodal counts can be trusted: one for each 100 nodes.

    That far nine of ten published counts agree with those of a mesh ten times finer, on shapes without symmetry (experiment
    nodal_stability).
    """
    return max(1, node_count // NODES_PER_MODE)


def counted_domains(system: EigenSystem, graph: NodalGraph, counting: Counting = "filtered", seed: int = 0) -> Floats:
    """Return the nodal number of every mode, the constant one included.

    Parameters
    ----------
    system : EigenSystem
        Of a surface: its area is known.
    graph : NodalGraph
        Over its nodes.
    counting : "raw", "filtered", "soft" or "averaged"
        "raw" is definition 4.3.1 on the mesh; "averaged" the mean of the filtered counts over random bases of clusters.
    seed : int

    Raises
    ------
    ValueError
        If the counting is unknown or the system belongs to no surface.
    """
    if counting not in COUNTINGS:
        raise ValueError(f"counting {counting!r} is unknown, choose one of {', '.join(COUNTINGS)}")
    if counting == "raw":
        return nodal_counts(graph, system.vectors).astype(np.float64)
    if system.area <= 0:
        raise ValueError(f"the eigensystem has area {system.area:g}, thresholds of nodal domains need it positive")
    smallest = system.values[zero_modes(system)] if zero_modes(system) < len(system.values) else system.values[-1]
    values = np.maximum(system.values, 1e-3 * smallest)
    saddles, peaks = nodal_thresholds(values, system.area, len(system.vectors))
    if counting == "soft":
        return soft_nodal_counts(graph, system.vectors, saddles, peaks)
    if counting == "averaged":
        return cluster_averaged_counts(graph, system, saddles, peaks, seed=seed)[0]
    return filtered_nodal_counts(graph, system.vectors, saddles, peaks).astype(np.float64)


def zero_modes(system: EigenSystem) -> int:
    """Return the number of constant modes, one for each component of a closed or Neumann surface."""
    return int((system.values <= 1e-6 * system.values[-1]).sum()) if len(system.values) > 1 else 0


def courant_report(system: EigenSystem, counts: Floats) -> tuple[dict[str, float], tuple[str, ...]]:
    """Return the number of modes beyond Courant's bound, and a note where there are some."""
    broken = courant_violations(np.floor(counts + 1e-9).astype(np.int64))
    notes = (
        (f"{len(broken)} modes have more domains than Courant's bound, the first is {broken[0]}.",)
        if len(broken)
        else ()
    )
    return {"courant_violations": float(len(broken))}, notes
