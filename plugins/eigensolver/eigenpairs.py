"""The first eigenpairs of the Laplace-Beltrami operator, by four methods."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.surface_spectrum import surface_spectrum

Count = Annotated[int, Field(ge=1, le=5000, description="number of pairs, k")]
Order = Annotated[Literal[1, 2, 3], Field(description="order of the elements")]
Curved = Annotated[bool, Field(description="nodes of order 2, 3 on the smooth surface: sphere, disk, torus")]
Patches = Annotated[bool, Field(description="nodes of order 2, 3 on cubic patches through vertices and normals")]
Mass = Annotated[Literal["consistent", "lumped", "averaged"], Field(description="mass matrix")]
Boundary = Annotated[Literal["neumann", "dirichlet"], Field(description="condition on the boundary")]
Tolerance = Annotated[float, Field(ge=1e-12, le=0.01, description="largest relative residual")]
Seed = Annotated[int, Field(ge=0, description="seed of the starting vectors")]


METRICS = {
    "factorisations": Metric("factorisations of the shifted pencil", better="lower"),
    "factor_entries_per_row": Metric("entries of the factor a row", better="lower"),
    "basis_size": Metric("vectors of all Lanczos bases", better="lower"),
    "slices": Metric("intervals of the spectrum"),
    "polishes": Metric("vectors improved at the end", better="lower"),
}


@register("eigensolver", "slicing", metrics=METRICS, defaults_of=surface_spectrum)
def slicing_eigensolver(
    surface: Surface,
    operator: SurfaceOperator,
    *,
    count: Count = 50,
    order: Order,
    curved: Curved,
    patches: Patches,
    mass: Mass,
    boundary: Boundary,
    tolerance: Tolerance,
    seed: Seed,
) -> EigenSystem:
    """Shifted LDL factors, block Lanczos and inertia counts: proved complete, the default."""
    return surface_spectrum(
        surface,
        operator,
        count=count,
        order=order,
        curved=curved,
        patches=patches,
        mass=mass,
        boundary=boundary,
        tolerance=tolerance,
        seed=seed,
        method="auto",
        progress=report_progress,
    )


@register("eigensolver", "arpack", defaults_of=surface_spectrum)
def arpack_eigensolver(
    surface: Surface,
    operator: SurfaceOperator,
    *,
    count: Count = 50,
    order: Order,
    curved: Curved,
    patches: Patches,
    mass: Mass,
    boundary: Boundary,
    tolerance: Tolerance,
    seed: Seed,
) -> EigenSystem:
    """Shift-invert Lanczos of ARPACK with our factorisation, the plain reference."""
    return surface_spectrum(
        surface,
        operator,
        count=count,
        order=order,
        curved=curved,
        patches=patches,
        mass=mass,
        boundary=boundary,
        tolerance=tolerance,
        seed=seed,
        method="arpack",
    )


@register("eigensolver", "lobpcg", defaults_of=surface_spectrum)
def lobpcg_eigensolver(
    surface: Surface,
    operator: SurfaceOperator,
    *,
    count: Count = 50,
    order: Order,
    curved: Curved,
    patches: Patches,
    mass: Mass,
    boundary: Boundary,
    tolerance: Tolerance = 1e-05,
    seed: Seed,
) -> EigenSystem:
    """Locally optimal block iterations with multigrid, without factorisation and without proof."""
    return surface_spectrum(
        surface,
        operator,
        count=count,
        order=order,
        curved=curved,
        patches=patches,
        mass=mass,
        boundary=boundary,
        tolerance=tolerance,
        seed=seed,
        method="lobpcg",
    )


@register("eigensolver", "dense", defaults_of=surface_spectrum)
def dense_eigensolver(
    surface: Surface,
    operator: SurfaceOperator,
    *,
    count: Count = 50,
    order: Order,
    curved: Curved,
    patches: Patches,
    mass: Mass,
    boundary: Boundary,
    tolerance: Tolerance,
    seed: Seed,
) -> EigenSystem:
    """All eigenpairs by dense algebra, for meshes up to 6,000 unknowns."""
    return surface_spectrum(
        surface,
        operator,
        count=count,
        order=order,
        curved=curved,
        patches=patches,
        mass=mass,
        boundary=boundary,
        tolerance=tolerance,
        seed=seed,
        method="dense",
    )
