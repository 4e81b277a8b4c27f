"""The lowest eigenpairs of a surface, also where slivers among its triangles stop the eigensolver."""

from __future__ import annotations

from dataclasses import replace

from scipy.sparse import csr_array

from surfexp.mesh.surface import Surface
from surfexp.mesh.thin_faces import sharp_faces
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.elements_surface import Boundary, Mass
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensolver_error import EigensolverError, SliverError
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.single_slice import Progress
from surfexp.spectrum.surface_spectrum import surface_spectrum

# degrees; entries of the stiffness, and with them its rounding, grow by the cotangent, which is 11 there
SLIVER = 5.0


def lowest_pairs(
    surface: Surface,
    count: int,
    *,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    tolerance: float = 1e-8,
    progress: Progress | None = None,
    threads: int = 1,
) -> tuple[SurfaceOperator, EigenSystem]:
    """Find the lowest pairs with linear elements on the triangles of a surface, or on its intrinsic Delaunay triangles.

    The second are taken where slivers among the first leave the pairs in doubt; a note says so.

    Parameters
    ----------
    surface : Surface
    count, mass, boundary, tolerance, progress, threads
        As in `surface_spectrum`.

    Returns
    -------
    operator : SurfaceOperator
        Of the triangles that were taken; its notes say what stopped the others.
    system : EigenSystem

    Raises
    ------
    ValueError
        If neither gives certified pairs, or the request is unfit.
    """

    def pairs(operator: SurfaceOperator) -> EigenSystem:
        return surface_spectrum(
            *(surface, assembled(operator), count),
            mass=mass,
            boundary=boundary,
            tolerance=tolerance,
            progress=progress,
            threads=threads,
        )

    operator = fem(surface.mesh)
    try:
        return operator, pairs(operator)
    except SliverError as stopped:
        operator = without_slivers(surface, stopped)
        system = pairs(operator)
    return operator, replace(system, notes=operator.notes + system.notes)


def assembled(operator: SurfaceOperator) -> SurfaceOperator:
    """Return an operator with its stiffness and consistent mass, summed in one pass over the faces.

    The general assembly of elements of any order takes twenty times as long, and agrees to rounding.

    Parameters
    ----------
    operator : SurfaceOperator
    """
    summed = stiffness(operator)
    # the two triangles of the stiffness may differ by rounding
    return replace(operator, matrices=(csr_array(0.5 * (summed + summed.T)), mass_matrix(operator)))


def without_slivers(surface: Surface, stopped: SliverError) -> SurfaceOperator:
    """Return the operator of the intrinsic Delaunay triangles of a surface, with a note that says why they are taken.

    Parameters
    ----------
    surface : Surface
    stopped : SliverError
        What its own triangles ended in.

    Raises
    ------
    EigensolverError
        If no triangle is a sliver, so that rounding alone stands against the tolerance.
    """
    reason = str(stopped).partition(":")[0]
    if not sharp_faces(surface.mesh, SLIVER).any():
        raise EigensolverError(
            f"{reason}, and no triangle has an angle under {SLIVER:g} degrees, so that others would not help: take a larger "
            "tolerance"
        ) from stopped
    operator = intrinsic_delaunay(surface.mesh)
    said = (
        f"Slivers stopped the eigensolver ({reason}): the pairs are of the intrinsic Delaunay triangles of the same surface, "
        f"{operator.metrics['flips']:.0f} edges flipped."
    )
    return replace(operator, notes=(said, *operator.notes))
