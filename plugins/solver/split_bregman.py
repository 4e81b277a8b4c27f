"""Split Bregman iterations (2.14)-(2.21)."""

from functools import partial
from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.published.split_bregman import published_split_bregman
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.split_bregman import split_bregman


@register("solver", "split_bregman", defaults_of=(split_bregman, published_split_bregman))
def split_bregman_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[
        float | None,
        Field(gt=0, lt=1, description="bound of the relative gap; default: 1e-4, of segmentation models 1e-2"),
    ],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations of one convex problem")],
    penalty: Annotated[
        float | None, Field(gt=0, description="the published lambda; default: from the model and edge length")
    ],
    relaxation: Annotated[float, Field(gt=0, lt=2, description="over-relaxation")],
    scheme: Annotated[
        Literal["sound", "as_published"],
        Field(
            description="as_published: the published iteration, for ROF and convex Chan-Vese, with the options below"
        ),
    ] = "sound",
    inner: Annotated[
        Literal["gauss_seidel", "cg", "direct"],
        Field(description="as_published: how the linear system is solved, on which the result depends"),
    ],
    sweeps: Annotated[
        int, Field(ge=1, le=1000, description="as_published: Gauss-Seidel sweeps or conjugate gradient steps")
    ],
    laplacian: Annotated[
        Literal["fem", "(1.19)"],
        Field(description="as_published: the consistent mass of (2.37), or the ring area / 3 of (1.19)"),
    ],
) -> Solution:
    """Split Bregman iterations with one factorisation, over-relaxed, constraints kept exactly; or as published."""
    shared = {
        "tolerance": tolerance,
        "iteration_limit": iteration_limit,
        "penalty": penalty,
        "progress": report_progress,
    }
    if scheme == "sound":
        return model.run(image, operator, partial(split_bregman, relaxation=relaxation, **shared))
    published = {"inner": inner, "sweeps": sweeps, "laplacian": laplacian}
    return model.run(image, operator, partial(published_split_bregman, **shared, **published))
