"""The primal-dual method of Chambolle and Pock."""

from functools import partial

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual


class PrimalDual(Options):
    """When to stop, and the first step."""

    tolerance: float | None = Field(
        None, gt=0, lt=1, description="bound of the relative gap; default: 1e-4, of segmentation models 1e-2"
    )
    iteration_limit: int = Field(20000, ge=1, description="most iterations of one convex problem")
    step: float | None = Field(None, gt=0, description="first primal step; default: from the model")


@register("solver", "primal_dual")
def primal_dual_solver(options: PrimalDual, *, image: Image, operator: SurfaceOperator, model: Model) -> Solution:
    """Primal-dual steps with a step length a face, accelerated where the model is strongly convex."""
    method = partial(primal_dual, **dict(options), progress=report_progress)
    return model.run(image, operator, method)
