"""Nodal count sequences, section 4.3."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.nodal_signature import counted_domains, courant_report, trusted_modes
from surfexp.spectrum.signature import Signature
from surfexp.spectrum.spectral_signature import spectrum_part
from surfexp.spectrum.surface_spectrum import graph_of


class NodalCounts(Options):
    """How domains are counted."""

    counting: Literal["raw", "filtered", "soft", "averaged"] = Field("filtered", description="raw is as published")
    seed: int = Field(0, ge=0, description="seed of the random bases that averaged takes")


METRICS = {
    "count_{mode}": Metric("nodal domains of a mode, the constant is mode 0"),
    "total": Metric("sum of all counts"),
    "courant_violations": Metric("modes with more domains than Courant's bound", better="lower"),
    "trusted_modes": Metric("modes whose counts the mesh resolves"),
}


@register("signature", "nodal_counts", metrics=METRICS)
def nodal_counts_signature(options: NodalCounts, *, operator: SurfaceOperator, eigensolver: EigenSystem) -> Signature:
    """Numbers of nodal domains of the modes after the constant one (definition 4.3.1)."""
    counts = counted_domains(eigensolver, graph_of(operator, eigensolver), options.counting, options.seed)
    metrics, notes = courant_report(eigensolver, counts)
    metrics |= {f"count_{i}": float(counts[i]) for i in range(min(len(counts), 12))}
    metrics |= {"total": float(counts.sum()), "trusted_modes": float(trusted_modes(len(eigensolver.vectors)))}
    return Signature(spectrum_part(eigensolver, counts), "nodal_counts", metrics=metrics, notes=notes)
