"""A data term carried from a surface to another domain that represents it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from surfexp.contract.arrays import Floats
from surfexp.variational.separable_quadratic import SeparableQuadratic


def transported(fidelity: SeparableQuadratic, mass: Floats, carry: Callable[[Floats], Floats]) -> SeparableQuadratic:
    """Return the same data term on a domain of other points.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        On the vertices of the surface, one channel.
    mass : (k,) float64
        Areas on the surface that the points of the domain stand for.
    carry : callable
        Takes (n,) values at the vertices to (k,) values on the domain; constants must stay.

    Raises
    ------
    ValueError
        If the fidelity has several channels.
    """
    if len(fidelity.shape) != 1:
        raise ValueError(f"the image has shape {fidelity.shape}, a baseline takes one channel, of shape (vertices,)")
    trivial = fidelity.trivial_energy
    return replace(
        fidelity,
        mass=mass,
        weight=carry(fidelity.weight),
        target=carry(fidelity.target),
        slope=carry(fidelity.slope),
        trivial_energy=None if trivial is None else trivial * float(mass.sum() / fidelity.mass.sum()),
    )
