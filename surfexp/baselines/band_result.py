"""From values on a narrow band to a solution at the vertices."""

from __future__ import annotations

import numpy as np

from surfexp.baselines.band_energy import BandEnergy
from surfexp.baselines.grid_interpolation import GridInterpolation
from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution


def solution_at_vertices(
    energy: BandEnergy,
    to_vertices: GridInterpolation,
    fidelity: SeparableQuadratic,
    operator: SurfaceOperator,
    values: Floats,
    rows: list[tuple[float, float]],
    converged: bool,
    reason: str,
    solver: str,
    memory: int,
) -> Solution:
    """Interpolate to the vertices and evaluate the energy there.

    Parameters
    ----------
    energy, to_vertices
        Of the solver.
    fidelity, operator
        The problem on the surface, whose energy is reported.
    values : (k,) float64
        At the nodes of the band.
    rows : list of (iteration, energy on the band)
    converged, reason, solver
        As in `Solution`.
    memory : int
        Bytes of the representation.
    """
    band = energy.band
    at_vertices = np.clip(to_vertices(values), fidelity.lower, fidelity.upper)
    constancy = band.extend(at_vertices) - values
    iterations, energies = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
    surface_energy = total_variation(operator, at_vertices) + fidelity.value(at_vertices)
    metrics = {
        "energy": surface_energy,
        "iterations": float(iterations[-1]),
        "band_energy": float(energies[-1]),
        "node_count": float(band.node_count),
        "grid_points": float(np.prod(band.shape)),
        "memory_bytes": float(memory),
        "normal_variation": float(np.sqrt(energy.mass @ constancy**2 / energy.mass.sum())),
    }
    return Solution(
        values=at_vertices,
        energy=surface_energy,
        iterations=int(iterations[-1]),
        converged=converged,
        reason=reason,
        history={"iteration": iterations, "energy": energies},
        model=fidelity.name,
        solver=solver,
        metrics=metrics,
        notes=("no certificate: solved on a grid around the surface, energy measured on the mesh",),
    )
