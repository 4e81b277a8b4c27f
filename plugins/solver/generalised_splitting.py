"""Split Bregman iterations for total generalised variation."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.variational.model import solver_of_models
from surfexp.variational.solvers.generalised_splitting import generalised_splitting

register(
    "solver",
    "generalised_splitting",
    summary="Split Bregman iterations with one factorisation for u and w together, certified.",
    accepts={"model": ("tgv",)},
    options={
        "tolerance": Field(gt=0, lt=1, description="bound of the relative gap"),
        "iteration_limit": Field(ge=1, description="most iterations"),
        "penalty": Field(
            gt=0, description="of grad u - w; default: 9 over the mean length of the gradient of the image"
        ),
        "relaxation": Field(gt=0, lt=2, description="over-relaxation"),
    },
    given={"progress": report_progress},
)(solver_of_models(generalised_splitting))
