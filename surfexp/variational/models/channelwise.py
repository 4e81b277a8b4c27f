"""Channels denoised one by one, as published for coordinates and colours; the result depends on the axes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import certificate_of
from surfexp.variational.fidelity import Method
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution


def solve_by_channel(fidelity: SeparableQuadratic, operator: SurfaceOperator, method: Method) -> Solution:
    """Return the solutions of the channels side by side, with the sums of their energies and bounds.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        Of shape (n, c).
    operator : SurfaceOperator
    method : Method
    """
    parts = [method(fidelity.channel(c), operator) for c in range(fidelity.shape[1])]
    energy = sum(part.energy for part in parts)
    bounds = [part.lower_bound for part in parts if part.lower_bound is not None]
    lower_bound = sum(bounds) if len(bounds) == len(parts) else None
    gap = relative_gap = error_bound = None
    if lower_bound is not None:
        gap = max(energy - lower_bound, 0.0)
        certificate = certificate_of(
            energy, lower_bound, fidelity.gap_scale(energy, lower_bound), fidelity.strong_convexity
        )
        relative_gap, error_bound = certificate.relative_gap, certificate.error_bound
    numbers = {
        "energy": energy,
        "iterations": float(max(part.iterations for part in parts)),
        "lower_bound": lower_bound,
        "gap": gap,
        "relative_gap": relative_gap,
        "error_bound": error_bound,
    }
    worst = max(parts, key=lambda part: (not part.converged, part.iterations))
    duals = [part.dual for part in parts if part.dual is not None]
    return replace(
        worst,
        values=np.stack([part.values for part in parts], axis=1),
        dual=np.stack(duals, axis=1) if len(duals) == len(parts) else None,
        energy=energy,
        lower_bound=lower_bound,
        relative_gap=relative_gap,
        error_bound=error_bound,
        metrics={name: number for name, number in numbers.items() if number is not None},
        notes=(*worst.notes, "Channels were solved one by one: the energy is the sum of their total variations."),
    )
