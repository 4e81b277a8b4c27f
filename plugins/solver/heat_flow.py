"""Heat flow on the surface."""

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.assembly import stiffness
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution
from surfexp.variational.surface_flows import heat_flow
from surfexp.variational.truth_metrics import RESTORATION_METRICS, restoration_metrics

METRICS = {
    "time": Metric("end time", "unit of length squared"),
    "total_variation": Metric("total variation of the result, where the operator has gradients"),
    "mean_drift": Metric("change of the mean", "unit of the image", "lower"),
    **RESTORATION_METRICS,
}


@register("solver", "heat_flow", metrics=METRICS, defaults_of=heat_flow)
def heat_flow_solver(
    image: Image,
    operator: SurfaceOperator,
    *,
    width: Annotated[
        float, Field(gt=0, description="standard deviation sqrt(2 time) of the kernel in edge lengths")
    ] = 2.0,
    steps: Annotated[int, Field(ge=1, le=10000, description="implicit Euler steps")],
) -> Solution:
    """The image after diffusing for a time, by implicit Euler steps: the linear filter beside total variation."""
    time = 0.5 * (width * operator.edge_length) ** 2
    values = heat_flow(operator, image.values, time, steps)
    flat = values.reshape(len(values), -1)
    solution = Solution(
        values,
        0.5 * float((flat * (stiffness(operator) @ flat)).sum()),
        iterations=steps,
        reason="end time",
        model="heat flow",
        solver="implicit",
    )
    drift = float(abs(operator.mass @ (values - image.values)).max() / operator.mass.sum())
    numbers = {"time": time, "mean_drift": drift}
    if operator.matrices is None:
        numbers["total_variation"] = total_variation(operator, values)
    return replace(solution, metrics=numbers | restoration_metrics(image, operator, values))
