"""The primal-dual method for total generalised variation."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.variational.model import solver_of_models
from surfexp.variational.solvers.generalised_primal_dual import generalised_primal_dual

register(
    "solver",
    "generalised_primal_dual",
    summary="Primal-dual steps without a factorisation but for the certificate; slower, and independent.",
    accepts={"model": ("tgv",)},
    options={
        "tolerance": Field(gt=0, lt=1, description="bound of the relative gap"),
        "iteration_limit": Field(ge=1, description="most iterations"),
        "step": Field(gt=0, description="ratio of the steps; default: spread of the image / 100 h"),
    },
    given={"progress": report_progress},
)(solver_of_models(generalised_primal_dual))
