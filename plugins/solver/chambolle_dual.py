"""Chambolle's dual projection method (2.26)-(2.32)."""

from functools import partial
from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.published.chambolle import published_chambolle
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_dual import chambolle_dual


class ChambolleDual(Options):
    """When to stop, and the scheme with its published parameters."""

    tolerance: float | None = Field(
        None, gt=0, lt=1, description="bound of the relative gap; default: 1e-4, of segmentation models 1e-2"
    )
    iteration_limit: int = Field(20000, ge=1, description="most iterations of one convex problem")
    scheme: Literal["sound", "as_published"] = Field(
        "sound", description="sound: strongly convex models; as_published: ROF and convex Chan-Vese, options below"
    )
    tau: float | None = Field(
        None, gt=0, description="as_published: the published step; default: its largest stable value"
    )
    theta: float | None = Field(
        None, gt=0, description="as_published: weight of |phi - v|^2 in (2.29); default: 10 mean |mu r|"
    )
    inner_steps: int = Field(10, ge=1, le=1000, description="as_published: dual steps between two updates of v")


@register("solver", "chambolle_dual", accepts={"model": ("rof", "vectorial_rof", "convex_chan_vese")})
def chambolle_dual_solver(options: ChambolleDual, *, image: Image, operator: SurfaceOperator, model: Model) -> Solution:
    """Semi-implicit dual iteration with a step length a face; or as published, with one step length everywhere."""
    shared = options.model_dump(include={"tolerance", "iteration_limit"}) | {"progress": report_progress}
    if options.scheme == "sound":
        return model.run(image, operator, partial(chambolle_dual, **shared))
    published = options.model_dump(include={"tau", "theta", "inner_steps"})
    return model.run(image, operator, partial(published_chambolle, **shared, **published))
