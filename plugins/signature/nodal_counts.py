"""Nodal count sequences, section 4.3."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.nodal_signature import counted_domains, courant_report, trusted_modes
from surfexp.spectrum.signature import Signature
from surfexp.spectrum.spectral_signature import spectrum_part
from surfexp.spectrum.surface_spectrum import graph_of

METRICS = {
    "count_{mode}": Metric("nodal domains of a mode, the constant is mode 0"),
    "total": Metric("sum of all counts"),
    "courant_violations": Metric("modes with more domains than Courant's bound", better="lower"),
    "trusted_modes": Metric("modes whose counts the mesh resolves"),
}


@register("signature", "nodal_counts", metrics=METRICS, defaults_of=counted_domains)
def nodal_counts_signature(
    operator: SurfaceOperator,
    eigensolver: EigenSystem,
    *,
    counting: Annotated[Literal["raw", "filtered", "soft", "averaged"], Field(description="raw is as published")],
    seed: Annotated[int, Field(ge=0, description="seed of the random bases that averaged takes")],
) -> Signature:
    """Numbers of nodal domains of the modes after the constant one (definition 4.3.1)."""
    counts = counted_domains(eigensolver, graph_of(operator, eigensolver), counting, seed)
    metrics, notes = courant_report(eigensolver, counts)
    metrics |= {f"count_{i}": float(counts[i]) for i in range(min(len(counts), 12))}
    metrics |= {"total": float(counts.sum()), "trusted_modes": float(trusted_modes(len(eigensolver.vectors)))}
    return Signature(spectrum_part(eigensolver, counts), "nodal_counts", metrics=metrics, notes=notes)
