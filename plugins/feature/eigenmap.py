"""The Laplace-Beltrami eigenmap as a feature."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.skeleton.eigenmap import eigenmap
from surfexp.skeleton.feature import Feature

METRICS = {
    "eigenvalue": Metric("its eigenvalue"),
    "gap": Metric("distance to the nearest other eigenvalue, relative", better="higher"),
    "residual": Metric("relative residual of the pair", better="lower"),
}


@register("feature", "eigenmap", metrics=METRICS, defaults_of=eigenmap)
def eigenmap_feature(
    surface: Surface,
    operator: SurfaceOperator,
    *,
    index: Annotated[
        int, Field(ge=1, le=200, description="number of the eigenfunction, counted from the constant one, 0")
    ],
) -> Feature:
    """Eigenfunction of the operator, isotropic or weighted, with free boundary (5.4)."""
    return eigenmap(operator, index)
