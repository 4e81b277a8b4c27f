"""Accelerated projected gradients on the dual problem."""

from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.fista_dual import fista_dual


@register("solver", "fista_dual", accepts={"model": ("rof", "vectorial_rof")}, defaults_of=fista_dual)
def fista_dual_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap")],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations")],
) -> Solution:
    """FISTA on the dual of a strongly convex model, restarted when the momentum points backwards."""
    return model.run(
        image,
        operator,
        partial(fista_dual, tolerance=tolerance, iteration_limit=iteration_limit, progress=report_progress),
    )
