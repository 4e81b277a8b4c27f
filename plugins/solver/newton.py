"""Newton's method on the central path, to gaps of 1e-10."""

from functools import partial

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.newton import newton


class Newton(Options):
    """When to stop."""

    tolerance: float = Field(1e-10, gt=0, lt=1, description="bound of the relative gap")
    iteration_limit: int = Field(60, ge=1, le=1000, description="most factorisations")


@register("solver", "newton", accepts={"model": ("rof",)})
def newton_solver(options: Newton, *, image: Image, operator: SurfaceOperator, model: Model) -> Solution:
    """Newton steps with several corrections for ROF: about ten factorisations to a relative gap of 1e-10."""
    return model.run(image, operator, partial(newton, **dict(options), progress=report_progress))
