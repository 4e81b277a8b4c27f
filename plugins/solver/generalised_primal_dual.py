"""The primal-dual method for total generalised variation."""

from functools import partial
from typing import Annotated, cast

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.models.tgv import TGV
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.generalised_primal_dual import generalised_primal_dual


@register("solver", "generalised_primal_dual", accepts={"model": ("tgv",)}, defaults_of=generalised_primal_dual)
def generalised_primal_dual_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap")],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations")],
    step: Annotated[float | None, Field(gt=0, description="ratio of the steps; default: spread of the image / 100 h")],
) -> Solution:
    """Primal-dual steps without a factorisation but for the certificate; slower, and independent."""
    method = partial(
        generalised_primal_dual,
        tolerance=tolerance,
        iteration_limit=iteration_limit,
        step=step,
        progress=report_progress,
    )
    return cast(TGV, model).run(image, operator, method)
