"""How far an eigenvalue, and a descriptor made of eigenvalues, can be from the true one of the mesh."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem


def value_radii(operator: SurfaceOperator, system: EigenSystem) -> Floats:
    """Return for each pair a distance within which the pencil has an eigenvalue.

    That is the residual |A x - lambda B x| in the norm of B^-1 over |x| in that of B. B is at least a quarter of the
    lumped mass, triangle by triangle, so the residual is weighed by four over the areas of the vertices.

    Parameters
    ----------
    operator : SurfaceOperator
        Linear elements.
    system : EigenSystem
        Of the same vertices, with the consistent mass.

    Returns
    -------
    (k,) float64
        In the unit of the eigenvalues.

    Raises
    ------
    ValueError
        If the vectors belong to another mesh.
    """
    stiff, mass = stiffness(operator), mass_matrix(operator)
    if len(system.vectors) != stiff.shape[0]:
        raise ValueError(f"vectors have {len(system.vectors)} rows, the operator has {stiff.shape[0]} vertices")
    images = mass @ system.vectors
    residuals = stiff @ system.vectors - images * system.values
    lumped = np.asarray(mass.sum(axis=1)).ravel()
    sizes = (system.vectors * images).sum(axis=0)
    return np.asarray(2.0 * np.sqrt((residuals**2 / lumped[:, None]).sum(axis=0) / sizes))


def share_beyond(first: Floats, second: Floats, radii: Floats, other_radii: Floats) -> Floats:
    """Return for each descriptor whether some entry differs by more than both certificates together.

    Parameters
    ----------
    first, second : (p, d) float64
        Descriptors of p surfaces by two routes.
    radii, other_radii : (p, d) float64
        Their certificates.

    Returns
    -------
    (p,) float64
        1 where one does, else 0.
    """
    return np.asarray((np.abs(first - second) > radii + other_radii).any(axis=1), dtype=np.float64)
