"""Split Bregman iterations for total generalised variation."""

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
from surfexp.variational.solvers.generalised_splitting import generalised_splitting


class GeneralisedSplitting(Options):
    """When to stop, and the penalty."""

    tolerance: float = Field(1e-4, gt=0, lt=1, description="bound of the relative gap")
    iteration_limit: int = Field(20000, ge=1, description="most iterations")
    penalty: float | None = Field(
        None, gt=0, description="of grad u - w; default: 9 over the mean length of the gradient of the image"
    )
    relaxation: float = Field(1.8, gt=0, lt=2, description="over-relaxation")


@register("solver", "generalised_splitting", accepts={"model": ("tgv",)})
def generalised_splitting_solver(
    options: GeneralisedSplitting, *, image: Image, operator: SurfaceOperator, model: Model
) -> Solution:
    """Split Bregman iterations with one factorisation for u and w together, certified."""
    method = partial(generalised_splitting, **dict(options), progress=report_progress)
    return cast(TGV, model).run(image, operator, method)
