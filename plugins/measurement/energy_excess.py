"""How far any method's result is from the minimum on the surface."""

from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.baselines.energy_excess import energy_excess
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.statistics.measurement import Measurement
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.models.rof import ROF
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual

METRICS = {
    "energy_excess": Metric("energy above the least one found by any method, relative", better="lower"),
}


@register("measurement", "energy_excess", metrics=METRICS, accepts={"model": ("rof", "convex_chan_vese")})
def energy_excess_measurement(
    solver: Solution,
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    tolerance: Annotated[
        float, Field(gt=0, lt=1, description="relative gap of the intrinsic solve that gives the bound")
    ] = 1e-06,
) -> Measurement:
    """The energy of any method's result on the surface, held against a proved lower bound."""
    if isinstance(model, ConvexChanVese):
        fidelity, _ = model.fidelity(image, operator, (solver.metrics["c1"], solver.metrics["c2"]))
    elif isinstance(model, ROF):
        fidelity = model.fidelity(image, operator)
    else:
        raise ValueError(f"energy_excess knows rof and convex_chan_vese, not {type(model).__name__}")
    bound = partial(primal_dual, tolerance=tolerance, progress=report_progress)(fidelity, operator).lower_bound
    assert bound is not None  # noqa: S101, narrows a type
    excess = energy_excess(fidelity, operator, solver.values, bound)
    return Measurement(solver.solver, solver.metrics | {"energy_excess": excess}, solver.notes)
