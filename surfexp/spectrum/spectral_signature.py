"""All spectral signatures of one surface at once, and the one that joins spectrum and counts."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.nodal_signature import counted_domains, courant_report, trusted_modes, zero_modes
from surfexp.spectrum.shape_distributions import (
    embedding_distances,
    heat_distribution,
    scaled_heat_trace,
    wave_distribution,
)
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.spectrum.signature import Signature
from surfexp.spectrum.surface_spectrum import graph_of, surface_spectrum

Order = Literal[1, 2, 3]


def spectral_signature(
    surface: Surface, operator: SurfaceOperator, count: int = 100, order: Order = 1, seed: int = 0
) -> Signature:
    """Compute `count` modes after the constant one, and every signature of them.

    Returns
    -------
    Signature
        The spectrum times the area. Parts: "shape_dna_raw", "shape_dna_reweighted" (over n), "nodal_counts" (filtered),
        "nodal_raw" (published), "nodal_soft", "combined", "heat_trace", "hks", "wks", "gps", "area".
    """
    pieces = surface.mesh.component_count
    system = surface_spectrum(surface, operator, count + pieces, order=order, seed=seed)
    start = zero_modes(system)
    graph, weights = graph_of(operator, system), operator.mass
    filtered = counted_domains(system, graph, "filtered")
    reweighted = shape_dna(system.values, "area", system.area, reweighted=True)[:count]
    counts = filtered[start : start + count]
    parts = {
        "shape_dna_raw": shape_dna(system.values, "raw")[:count],
        "shape_dna_reweighted": reweighted,
        "nodal_counts": counts,
        "nodal_raw": counted_domains(system, graph, "raw")[start : start + count],
        "nodal_soft": counted_domains(system, graph, "soft")[start : start + count],
        "combined": joined_signature(reweighted, counts),
        "heat_trace": scaled_heat_trace(system),
        "hks": heat_distribution(system, weights),
        "wks": wave_distribution(system, weights),
        "gps": embedding_distances(system, weights, seed),
        "area": np.array([system.area]),
    }
    violations, notes = courant_report(system, filtered)
    trusted = trusted_modes(len(system.vectors))
    if count > trusted:
        notes += (
            f"{count} modes on {len(system.vectors)} nodes: nodal counts beyond mode {trusted} are mostly noise.",
        )
    metrics = {name: system.metrics[name] for name in ("complete", "largest_residual", "area", "edge_length")}
    metrics |= {
        "trusted_modes": float(trusted),
        **violations,
        "mean_count_ratio": float((counts / _numbers(count)).mean()),
    }
    values = shape_dna(system.values, "area", system.area)[:count]
    return Signature(values, "shape_dna", parts, metrics, (*system.notes, *notes))


def joined_signature(reweighted: Floats, counts: Floats) -> Floats:
    """Return lambda_n A / (4 pi n), which tends to 1, followed by count_n / n, which Courant's bound keeps below 1 + 1/n.

    Section 4.5 promises the two together; divided by n as in (4.3) with alpha = 1, they weigh alike.
    """
    return np.concatenate([reweighted / (4.0 * np.pi), counts / _numbers(len(counts))])


def spectrum_part(system: EigenSystem, counts: Floats) -> Floats:
    """Return the counts of the modes after the constant ones."""
    return counts[zero_modes(system) :]


def _numbers(count: int) -> Floats:
    return np.arange(1.0, count + 1.0)
