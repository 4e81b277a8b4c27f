"""Gradient descent on the regularised total variation."""

from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.gradient_descent import gradient_descent


@register("solver", "gradient_descent", defaults_of=gradient_descent)
def gradient_descent_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap")],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations of one convex problem")],
    smoothing: Annotated[
        float | None,
        Field(gt=0, description="eps in sqrt(|grad|^2 + eps^2), a gradient; default: 1 % of the mean gradient"),
    ],
) -> Solution:
    """Explicit steps on the regularised total variation: what the fast methods are measured against."""
    return model.run(
        image,
        operator,
        partial(
            gradient_descent,
            tolerance=tolerance,
            iteration_limit=iteration_limit,
            smoothing=smoothing,
            progress=report_progress,
        ),
    )
