"""Newton's method on the central path, to gaps of 1e-10."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.variational.model import solver_of_models
from surfexp.variational.solvers.newton import newton

register(
    "solver",
    "newton",
    summary="Newton steps with several corrections for ROF: about ten factorisations to a relative gap of 1e-10.",
    accepts={"model": ("rof",)},
    options={
        "tolerance": Field(gt=0, lt=1, description="bound of the relative gap"),
        "iteration_limit": Field(ge=1, le=1000, description="most factorisations"),
    },
    given={"progress": report_progress},
)(solver_of_models(newton))
