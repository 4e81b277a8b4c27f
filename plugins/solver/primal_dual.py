"""The primal-dual method of Chambolle and Pock."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.variational.model import solver_of_models
from surfexp.variational.solvers.primal_dual import primal_dual

register(
    "solver",
    "primal_dual",
    summary="Primal-dual steps with a step length a face, accelerated where the model is strongly convex.",
    options={
        "tolerance": Field(
            gt=0, lt=1, description="bound of the relative gap; default: 1e-4, of segmentation models 1e-2"
        ),
        "iteration_limit": Field(ge=1, description="most iterations of one convex problem"),
        "step": Field(gt=0, description="first primal step; default: from the model"),
    },
    given={"progress": report_progress},
)(solver_of_models(primal_dual))
