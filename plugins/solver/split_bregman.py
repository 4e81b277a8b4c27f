"""Split Bregman iterations (2.14)-(2.21)."""

from functools import partial

from pydantic import Field

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.split_bregman import split_bregman
from surfexp.workflow.registry import Options, register
from surfexp.workflow.stage import report_progress


class SplitBregman(Options):
    tolerance: float = Field(1e-4, gt=0, lt=1, description="bound of the relative gap")
    iteration_limit: int = Field(5000, ge=1, description="most iterations of one convex problem")
    penalty: float | None = Field(None, gt=0, description="the printed lambda; default: from the model and edge length")
    relaxation: float = Field(1.8, gt=0, lt=2, description="over-relaxation")


@register("solver", "split_bregman")
def split_bregman_solver(options: SplitBregman, *, image: Image, operator: SurfaceOperator, model: Model) -> Solution:
    """Split Bregman iterations with one factorisation, over-relaxed, constraints kept exactly."""
    method = partial(split_bregman, **dict(options), progress=report_progress)
    return model.run(image, operator, method)
