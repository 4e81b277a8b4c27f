"""The automatic choice of a method, held against the truth."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.statistics.statistic import Statistic
from surfexp.studies.smoothing.automatic_trial import automatic_trial
from surfexp.variational.image import Image

METRICS = {
    "rmse": Metric("root mean square error by area of the automatic choice", "unit of the image", "lower"),
    "rmse {method}": Metric("the same of one of the candidates", "unit of the image", "lower"),
    "chosen {method}": Metric("1 where this candidate was chosen, else 0"),
    "regret": Metric("error over that of the best candidate", better="lower"),
}


@register("statistic", "automatic_trial", metrics=METRICS, defaults_of=automatic_trial)
def automatic_trial_statistic(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    *,
    seed: Annotated[int, Field(ge=0, description="seed of the probe of Stein's estimate")],
) -> Statistic:
    """The first column of an image smoothed by what promises the least error, beside each candidate."""
    return automatic_trial(surface.mesh, operator, image, seed)
