"""The first eigenpairs of the Laplace-Beltrami operator, by four methods."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.surface_spectrum import surface_spectrum


class Eigenpairs(Options):
    """What is asked for, whatever the method."""

    count: int = Field(50, ge=1, le=5000, description="number of pairs, k")
    order: Literal[1, 2, 3] = Field(1, description="order of the elements")
    curved: bool = Field(False, description="nodes of order 2, 3 on the smooth surface: sphere, disk, torus")
    patches: bool = Field(False, description="nodes of order 2, 3 on cubic patches through vertices and normals")
    mass: Literal["consistent", "lumped", "averaged"] = Field("consistent", description="mass matrix")
    boundary: Literal["neumann", "dirichlet"] = Field("neumann", description="condition on the boundary")
    tolerance: float = Field(1e-8, ge=1e-12, le=1e-2, description="largest relative residual")
    seed: int = Field(0, ge=0, description="seed of the starting vectors")


class Sliced(Eigenpairs):
    """Spectrum slicing."""


class Arpack(Eigenpairs):
    """Implicitly restarted Lanczos."""


class Lobpcg(Eigenpairs):
    """Preconditioned block iterations."""

    tolerance: float = Field(1e-5, ge=1e-12, le=1e-2, description="largest relative residual")


class Dense(Eigenpairs):
    """Dense algebra."""


METRICS = {
    "factorisations": Metric("factorisations of the shifted pencil", better="lower"),
    "factor_entries_per_row": Metric("entries of the factor a row", better="lower"),
    "basis_size": Metric("vectors of all Lanczos bases", better="lower"),
    "slices": Metric("intervals of the spectrum"),
    "polishes": Metric("vectors improved at the end", better="lower"),
}


@register("eigensolver", "slicing", metrics=METRICS)
def slicing_eigensolver(options: Sliced, *, surface: Surface, operator: SurfaceOperator) -> EigenSystem:
    """Shifted LDL factors, block Lanczos and inertia counts: proved complete, the default."""
    return surface_spectrum(surface, operator, **dict(options), method="auto", progress=report_progress)


@register("eigensolver", "arpack")
def arpack_eigensolver(options: Arpack, *, surface: Surface, operator: SurfaceOperator) -> EigenSystem:
    """Shift-invert Lanczos of ARPACK with our factorisation, the plain reference."""
    return surface_spectrum(surface, operator, **dict(options), method="arpack")


@register("eigensolver", "lobpcg")
def lobpcg_eigensolver(options: Lobpcg, *, surface: Surface, operator: SurfaceOperator) -> EigenSystem:
    """Locally optimal block iterations with multigrid, without factorisation and without proof."""
    return surface_spectrum(surface, operator, **dict(options), method="lobpcg")


@register("eigensolver", "dense")
def dense_eigensolver(options: Dense, *, surface: Surface, operator: SurfaceOperator) -> EigenSystem:
    """All eigenpairs by dense algebra, for meshes up to 6,000 unknowns."""
    return surface_spectrum(surface, operator, **dict(options), method="dense")
