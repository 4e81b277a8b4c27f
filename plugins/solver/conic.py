"""The independent referee: an interior-point solver for second-order cones."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.variational.model import solver_of_models
from surfexp.variational.solvers.conic import conic

register(
    "solver",
    "conic",
    summary="CVXPY with CLARABEL, certified here; for small meshes (needs the extra [conic]).",
    accepts={"model": ("rof", "inpainting", "convex_chan_vese")},
    options={
        "tolerance": Field(gt=0, lt=1, description="relative gap at which the result counts as converged"),
    },
    given={"progress": report_progress},
)(solver_of_models(conic))
