"""Split Bregman iterations (2.14)-(2.21)."""

from functools import partial
from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.published.split_bregman import published_split_bregman
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.split_bregman import split_bregman


class SplitBregman(Options):
    """When to stop, the penalty, and the scheme with its published parameters."""

    tolerance: float | None = Field(
        None, gt=0, lt=1, description="bound of the relative gap; default: 1e-4, of segmentation models 1e-2"
    )
    iteration_limit: int = Field(5000, ge=1, description="most iterations of one convex problem")
    penalty: float | None = Field(
        None, gt=0, description="the published lambda; default: from the model and edge length"
    )
    relaxation: float = Field(1.8, gt=0, lt=2, description="over-relaxation")
    scheme: Literal["sound", "as_published"] = Field(
        "sound",
        description="as_published: the published iteration, for ROF and convex Chan-Vese, with the options below",
    )
    inner: Literal["gauss_seidel", "cg", "direct"] = Field(
        "gauss_seidel", description="as_published: how the linear system is solved, on which the result depends"
    )
    sweeps: int = Field(1, ge=1, le=1000, description="as_published: Gauss-Seidel sweeps or conjugate gradient steps")
    laplacian: Literal["fem", "(1.19)"] = Field(
        "fem", description="as_published: the consistent mass of (2.37), or the ring area / 3 of (1.19)"
    )


@register("solver", "split_bregman")
def split_bregman_solver(options: SplitBregman, *, image: Image, operator: SurfaceOperator, model: Model) -> Solution:
    """Split Bregman iterations with one factorisation, over-relaxed, constraints kept exactly; or as published."""
    shared = options.model_dump(include={"tolerance", "iteration_limit", "penalty"}) | {"progress": report_progress}
    if options.scheme == "sound":
        return model.run(image, operator, partial(split_bregman, relaxation=options.relaxation, **shared))
    published = options.model_dump(include={"inner", "sweeps", "laplacian"})
    return model.run(image, operator, partial(published_split_bregman, **shared, **published))
