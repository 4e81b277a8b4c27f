"""Newton's method on the central path, to gaps of 1e-10."""

from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.newton import newton


@register("solver", "newton", accepts={"model": ("rof",)}, defaults_of=newton)
def newton_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap")],
    iteration_limit: Annotated[int, Field(ge=1, le=1000, description="most factorisations")],
) -> Solution:
    """Newton steps with several corrections for ROF: about ten factorisations to a relative gap of 1e-10."""
    return model.run(
        image, operator, partial(newton, tolerance=tolerance, iteration_limit=iteration_limit, progress=report_progress)
    )
