"""The first eigenpairs of the Laplace-Beltrami operator, by four methods."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import Boundary, Mass
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.surface_spectrum import surface_spectrum

METRICS = {
    "factorisations": Metric("factorisations of the shifted pencil", better="lower"),
    "factor_entries_per_row": Metric("entries of the factor a row", better="lower"),
    "basis_size": Metric("vectors of all Lanczos bases", better="lower"),
    "slices": Metric("intervals of the spectrum"),
    "polishes": Metric("vectors improved at the end", better="lower"),
}
OPTIONS = {
    "count": Field(50, ge=1, le=5000, description="number of pairs, k"),
    "order": Annotated[Literal[1, 2, 3], Field(description="order of the elements")],
    "curved": Field(description="nodes of order 2, 3 on the smooth surface: sphere, disk, torus"),
    "patches": Field(description="nodes of order 2, 3 on cubic patches through vertices and normals"),
    "mass": Field(description="mass matrix"),
    "boundary": Field(description="condition on the boundary"),
    "tolerance": Field(ge=1e-12, le=0.01, description="largest relative residual"),
    "seed": Field(ge=0, description="seed of the starting vectors"),
}

register(
    "eigensolver",
    "slicing",
    summary="Shifted LDL factors, block Lanczos and inertia counts: proved complete, the default.",
    given={"method": "auto", "progress": report_progress},
    options=OPTIONS,
    metrics=METRICS,
)(surface_spectrum)

register(
    "eigensolver",
    "arpack",
    summary="Shift-invert Lanczos of ARPACK with our factorisation, the plain reference.",
    given={"method": "arpack"},
    options=OPTIONS,
)(surface_spectrum)


@register("eigensolver", "lobpcg", defaults_of=surface_spectrum)
def lobpcg_eigensolver(
    surface: Surface,
    operator: SurfaceOperator,
    *,
    count: Annotated[int, Field(ge=1, le=5000, description="number of pairs, k")] = 50,
    order: Annotated[Literal[1, 2, 3], Field(description="order of the elements")],
    curved: Annotated[bool, OPTIONS["curved"]],
    patches: Annotated[bool, OPTIONS["patches"]],
    mass: Annotated[Mass, OPTIONS["mass"]],
    boundary: Annotated[Boundary, OPTIONS["boundary"]],
    tolerance: Annotated[float, OPTIONS["tolerance"]] = 1e-5,
    seed: Annotated[int, OPTIONS["seed"]],
) -> EigenSystem:
    """Locally optimal block iterations with multigrid, without factorisation and without proof."""
    return surface_spectrum(
        surface, operator, count, "lobpcg", order, curved, mass, boundary, tolerance, seed, None, patches
    )


register(
    "eigensolver",
    "dense",
    summary="All eigenpairs by dense algebra, for meshes up to 6,000 unknowns.",
    given={"method": "dense"},
    options=OPTIONS,
)(surface_spectrum)
