"""Accelerated projected gradients on the dual problem."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.variational.model import solver_of_models
from surfexp.variational.solvers.fista_dual import fista_dual

register(
    "solver",
    "fista_dual",
    summary="FISTA on the dual of a strongly convex model, restarted when the momentum points backwards.",
    accepts={"model": ("rof", "vectorial_rof")},
    options={
        "tolerance": Field(gt=0, lt=1, description="bound of the relative gap"),
        "iteration_limit": Field(ge=1, description="most iterations"),
    },
    given={"progress": report_progress},
)(solver_of_models(fista_dual))
