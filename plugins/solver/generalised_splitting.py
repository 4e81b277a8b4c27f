"""Split Bregman iterations for total generalised variation."""

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
from surfexp.variational.solvers.generalised_splitting import generalised_splitting


@register("solver", "generalised_splitting", accepts={"model": ("tgv",)}, defaults_of=generalised_splitting)
def generalised_splitting_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap")],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations")],
    penalty: Annotated[
        float | None,
        Field(gt=0, description="of grad u - w; default: 9 over the mean length of the gradient of the image"),
    ],
    relaxation: Annotated[float, Field(gt=0, lt=2, description="over-relaxation")],
) -> Solution:
    """Split Bregman iterations with one factorisation for u and w together, certified."""
    method = partial(
        generalised_splitting,
        tolerance=tolerance,
        iteration_limit=iteration_limit,
        penalty=penalty,
        relaxation=relaxation,
        progress=report_progress,
    )
    return cast(TGV, model).run(image, operator, method)
