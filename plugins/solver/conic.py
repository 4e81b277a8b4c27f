"""The independent referee: an interior-point solver for second-order cones."""

from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.conic import conic


@register("solver", "conic", accepts={"model": ("rof", "inpainting", "convex_chan_vese")}, defaults_of=conic)
def conic_solver(
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="relative gap at which the result counts as converged")],
) -> Solution:
    """CVXPY with CLARABEL, certified here; for small meshes (needs the extra [conic])."""
    return model.run(image, operator, partial(conic, tolerance=tolerance, progress=report_progress))
