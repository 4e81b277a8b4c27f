"""The automatic choice of a method, held against the truth."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
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


class AutomaticTrial(Options):
    """The probe."""

    seed: int = Field(0, ge=0, description="seed of the probe of Stein's estimate")


@register("statistic", "automatic_trial", metrics=METRICS)
def automatic_trial_statistic(
    options: AutomaticTrial, *, surface: Surface, image: Image, operator: SurfaceOperator
) -> Statistic:
    """The first column of an image smoothed by what promises the least error, beside each candidate."""
    return automatic_trial(surface.mesh, operator, image, options.seed)
