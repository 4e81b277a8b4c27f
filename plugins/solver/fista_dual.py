"""Accelerated projected gradients on the dual problem."""

from functools import partial

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.fista_dual import fista_dual


class FistaDual(Options):
    """When to stop."""

    tolerance: float = Field(1e-4, gt=0, lt=1, description="bound of the relative gap")
    iteration_limit: int = Field(20000, ge=1, description="most iterations")


@register("solver", "fista_dual", accepts={"model": ("rof", "vectorial_rof")})
def fista_dual_solver(options: FistaDual, *, image: Image, operator: SurfaceOperator, model: Model) -> Solution:
    """FISTA on the dual of a strongly convex model, restarted when the momentum points backwards."""
    return model.run(image, operator, partial(fista_dual, **dict(options), progress=report_progress))
