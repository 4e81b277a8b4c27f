"""Segmentation by a threshold alone: the baseline without regularisation."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.level_sets import perimeters
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import SEGMENTATION_METRICS, segmentation_metrics

METRICS = {
    "perimeter": Metric("length of the boundary of the region", "unit of length"),
    "threshold": Metric("grey level that bounds the region", "unit of the image"),
    "brighter_share": Metric("share of the area in the brighter region"),
    **SEGMENTATION_METRICS,
}


@register("solver", "threshold", metrics=METRICS)
def threshold_solver(
    image: Image,
    operator: SurfaceOperator,
    *,
    rule: Annotated[
        Literal["sign", "otsu"], Field(description="zero, or Otsu's threshold between two classes")
    ] = "sign",
) -> Solution:
    """The region where the image exceeds zero, or Otsu's threshold; no energy, no certificate."""
    from skimage.filters import threshold_otsu

    level = 0.0 if rule == "sign" else float(threshold_otsu(image.values))
    region = image.values > level
    length = float(perimeters(operator, image.values, np.array([level]))[0])
    share = float(operator.mass @ region / operator.mass.sum())
    metrics = {"perimeter": length, "threshold": level, "brighter_share": share}
    return Solution(
        image.values, energy=length, segmentation=region.astype(float), reason="no iteration",
        model="threshold", solver=rule, metrics=metrics | segmentation_metrics(image, operator, region),
    )  # fmt: skip
