"""The independent referee: an interior-point solver for second-order cones."""

from functools import partial

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.conic import conic


class Conic(Options):
    """When to stop."""

    tolerance: float = Field(1e-6, gt=0, lt=1, description="relative gap at which the result counts as converged")


@register("solver", "conic", accepts={"model": ("rof", "inpainting", "convex_chan_vese")})
def conic_solver(options: Conic, *, image: Image, operator: SurfaceOperator, model: Model) -> Solution:
    """CVXPY with CLARABEL, certified here; for small meshes (needs the extra [conic])."""
    return model.run(image, operator, partial(conic, **dict(options), progress=report_progress))
