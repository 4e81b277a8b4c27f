"""How far the result of any method is from the minimum on the surface."""

from __future__ import annotations

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Fidelity


def energy_excess(fidelity: Fidelity, operator: SurfaceOperator, values: Floats, lower_bound: float) -> float:
    """Return (energy of `values` - lower bound) / scale, the relative gap under the certificate of another solution.

    Parameters
    ----------
    fidelity, operator
        The problem on the surface.
    values : (n,) float64
        A result of any method, such as a baseline.
    lower_bound : float
        Dual energy that an intrinsic solver has proved for the same problem.
    """
    energy = total_variation(operator, values) + fidelity.value(values)
    return (energy - lower_bound) / fidelity.gap_scale(energy, lower_bound)
