"""The automatic choice of a method, held against the truth."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.smoothing.automatic_trial import automatic_trial

METRICS = {
    "rmse": Metric("root mean square error by area of the automatic choice", "unit of the image", "lower"),
    "rmse {method}": Metric("the same of one of the candidates", "unit of the image", "lower"),
    "chosen {method}": Metric("1 where this candidate was chosen, else 0"),
    "regret": Metric("error over that of the best candidate", better="lower"),
}

register(
    "statistic",
    "automatic_trial",
    metrics=METRICS,
    summary="The first column of an image smoothed by what promises the least error, beside each candidate.",
    options={"seed": Field(ge=0, description="seed of the probe of Stein's estimate")},
)(automatic_trial)
