"""The primal-dual method of Chambolle and Pock."""

from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual


@register("solver", "primal_dual", defaults_of=primal_dual)
def primal_dual_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[
        float | None,
        Field(gt=0, lt=1, description="bound of the relative gap; default: 1e-4, of segmentation models 1e-2"),
    ],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations of one convex problem")],
    step: Annotated[float | None, Field(gt=0, description="first primal step; default: from the model")],
) -> Solution:
    """Primal-dual steps with a step length a face, accelerated where the model is strongly convex."""
    method = partial(
        primal_dual, tolerance=tolerance, iteration_limit=iteration_limit, step=step, progress=report_progress
    )
    return model.run(image, operator, method)
