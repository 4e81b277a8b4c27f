"""What may enter an eigensolver, and what may leave it."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.spectrum.eigensolver_error import EigensolverError, SliverError
from surfexp.spectrum.eigensystem import EigenSystem

LARGEST_SKEW = 1e-10
# in mean spacings; rounding moves the zero modes of a surface by less than a millionth of one
MOST_NEGATIVE = 1e-3
LARGEST_OVERLAP = 1e-8


def check_request(size: int, k: int, tolerance: float) -> None:
    """Refuse a number of pairs or a tolerance that no method can serve.

    Raises
    ------
    EigensolverError
    """
    if size < 1:
        raise EigensolverError("the matrices have 0 rows, an eigenproblem needs at least 1")
    if not 1 <= k <= size:
        raise EigensolverError(f"k = {k} eigenpairs of {size} degrees of freedom: take 1 <= k <= {size}")
    if not 1e-12 <= tolerance <= 1e-2:
        raise EigensolverError(f"tolerance = {tolerance:g}, take one between 1e-12 and 1e-2")


def check_pencil(stiffness: csr_array, mass: csr_array) -> None:
    """Refuse matrices that are not symmetric and finite, or have a diagonal that no surface gives.

    Raises
    ------
    EigensolverError
    """
    for name, matrix in (("stiffness", stiffness), ("mass", mass)):
        bad = int((~np.isfinite(matrix.data)).sum())
        if bad:
            raise EigensolverError(f"the {name} matrix has {bad} entries that are not finite: repair the mesh")
        skew = float(np.abs((matrix - matrix.T).data).max(initial=0.0))
        if skew > LARGEST_SKEW * float(np.abs(matrix.data).max(initial=0.0)):
            raise EigensolverError(
                f"the {name} matrix is not symmetric, by {skew:.1e}: take its symmetric part, or L with M L symmetric"
            )
    diagonal = mass.diagonal()
    if diagonal.min() <= 0:
        at = int(diagonal.argmin())
        raise EigensolverError(
            f"the mass of degree of freedom {at} is {diagonal[at]:g}, must be positive: "
            "repair the mesh, or remove vertices without a face"
        )
    diagonal = stiffness.diagonal()
    if diagonal.min() < 0:
        at = int(diagonal.argmin())
        raise EigensolverError(
            f"the stiffness of degree of freedom {at} is {diagonal[at]:g}, must not be negative: "
            "take -A if the matrix is a Laplacian of the other sign"
        )


def certified(system: EigenSystem, k: int, tolerance: float) -> EigenSystem:
    """Return the system if it holds k proved pairs, each within the tolerance, of a semidefinite stiffness.

    Raises
    ------
    EigensolverError
        `SliverError` where another triangulation of the same surface helps.
    """
    lowest, spacing = float(system.values.min(initial=np.inf)), system.spacing
    if system.inertia and lowest < -MOST_NEGATIVE * spacing:
        raise SliverError(
            f"the stiffness has an eigenvalue {lowest:.3g}, {-lowest / spacing:.1e} mean spacings below 0, at most "
            f"{MOST_NEGATIVE:g} is rounding: assemble it from a positive semidefinite energy"
        )
    if len(system.values) < k or not system.complete:
        counts = ", ".join(f"{count} below {shift:.6g}" for shift, count in system.inertia[-2:])
        raise SliverError(
            f"{len(system.values)} of k = {k} pairs converged, but the inertia ({counts or 'none'}) does not prove them "
            "the lowest: repair slivers, take operator intrinsic_delaunay, or method dense"
        )
    worst = int(system.residuals.argmax())
    if not system.residuals[worst] <= tolerance:
        raise SliverError(
            f"pair {worst} has residual {system.residuals[worst]:.1e}, above tolerance {tolerance:g}: repair slivers, "
            f"take operator intrinsic_delaunay, or tolerance {2.0 * system.residuals[worst]:.0e}"
        )
    if not system.orthogonality <= max(LARGEST_OVERLAP, tolerance):
        raise SliverError(
            f"the vectors are orthogonal to {system.orthogonality:.1e}, at most {max(LARGEST_OVERLAP, tolerance):.0e} "
            "proves them different: repair slivers, or take operator intrinsic_delaunay"
        )
    return system
