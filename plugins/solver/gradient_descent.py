"""Gradient descent on the regularised total variation."""

from functools import partial

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.gradient_descent import gradient_descent


class GradientDescent(Options):
    """When to stop, and the smoothing of the total variation."""

    tolerance: float = Field(1e-3, gt=0, lt=1, description="bound of the relative gap")
    iteration_limit: int = Field(20000, ge=1, description="most iterations of one convex problem")
    smoothing: float | None = Field(
        None, gt=0, description="eps in sqrt(|grad|^2 + eps^2), a gradient; default: 1 % of the mean gradient"
    )


@register("solver", "gradient_descent")
def gradient_descent_solver(
    options: GradientDescent, *, image: Image, operator: SurfaceOperator, model: Model
) -> Solution:
    """Explicit steps on the regularised total variation: what the fast methods are measured against."""
    return model.run(image, operator, partial(gradient_descent, **dict(options), progress=report_progress))
