"""Gradient descent on the regularised total variation."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.variational.model import solver_of_models
from surfexp.variational.solvers.gradient_descent import gradient_descent

register(
    "solver",
    "gradient_descent",
    summary="Explicit steps on the regularised total variation: what the fast methods are measured against.",
    options={
        "tolerance": Field(gt=0, lt=1, description="bound of the relative gap"),
        "iteration_limit": Field(ge=1, description="most iterations of one convex problem"),
        "smoothing": Field(
            gt=0, description="eps in sqrt(|grad|^2 + eps^2), a gradient; default: 1 % of the mean gradient"
        ),
    },
    given={"progress": report_progress},
)(solver_of_models(gradient_descent))
