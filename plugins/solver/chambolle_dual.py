"""Chambolle's dual projection method (2.26)-(2.32)."""

from functools import partial
from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.published.chambolle import published_chambolle
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_dual import chambolle_dual


@register(
    "solver",
    "chambolle_dual",
    accepts={"model": ("rof", "vectorial_rof", "convex_chan_vese")},
    defaults_of=(chambolle_dual, published_chambolle),
)
def chambolle_dual_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[
        float | None,
        Field(gt=0, lt=1, description="bound of the relative gap; default: 1e-4, of segmentation models 1e-2"),
    ],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations of one convex problem")],
    scheme: Annotated[
        Literal["sound", "as_published"],
        Field(description="sound: strongly convex models; as_published: ROF and convex Chan-Vese, options below"),
    ] = "sound",
    tau: Annotated[
        float | None, Field(gt=0, description="as_published: the published step; default: its largest stable value")
    ],
    theta: Annotated[
        float | None, Field(gt=0, description="as_published: weight of |phi - v|^2 in (2.29); default: 10 mean |mu r|")
    ],
    inner_steps: Annotated[int, Field(ge=1, le=1000, description="as_published: dual steps between two updates of v")],
) -> Solution:
    """Semi-implicit dual iteration with a step length a face; or as published, with one step length everywhere."""
    shared = {"tolerance": tolerance, "iteration_limit": iteration_limit, "progress": report_progress}
    if scheme == "sound":
        return model.run(image, operator, partial(chambolle_dual, **shared))
    published = {"tau": tau, "theta": theta, "inner_steps": inner_steps}
    return model.run(image, operator, partial(published_chambolle, **shared, **published))
