"""The primal-dual method for total generalised variation."""

from functools import partial
from typing import cast

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.models.tgv import TGV
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.generalised_primal_dual import generalised_primal_dual


class GeneralisedPrimalDual(Options):
    """When to stop, and the step."""

    tolerance: float = Field(1e-3, gt=0, lt=1, description="bound of the relative gap")
    iteration_limit: int = Field(100000, ge=1, description="most iterations")
    step: float | None = Field(None, gt=0, description="ratio of the steps; default: spread of the image / 100 h")


@register("solver", "generalised_primal_dual", accepts={"model": ("tgv",)})
def generalised_primal_dual_solver(
    options: GeneralisedPrimalDual, *, image: Image, operator: SurfaceOperator, model: Model
) -> Solution:
    """Primal-dual steps without a factorisation but for the certificate; slower, and independent."""
    method = partial(generalised_primal_dual, **dict(options), progress=report_progress)
    return cast(TGV, model).run(image, operator, method)
