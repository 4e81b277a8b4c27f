"""How near a result is to the truth, where the image carries it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image

RESTORATION_METRICS = {
    "rmse": Metric("root mean square error against the clean image, by area", "unit of the image", "lower"),
    "psnr": Metric("range of the clean image over the error", "dB", "higher"),
}
SEGMENTATION_METRICS = {
    "dice {reference}": Metric("overlap with a reference region, by area", better="higher"),
    "accuracy {reference}": Metric("share of the area labelled as in a reference", better="higher"),
}


def restoration_metrics(image: Image, operator: SurfaceOperator, values: Floats) -> dict[str, float]:
    """Return rmse and psnr against `image.clean`, or nothing where there is none.

    Both are area-weighted; the peak of psnr is the range of the clean image, in decibels.
    """
    if image.clean is None:
        return {}
    squares = ((values - image.clean) ** 2).reshape(len(values), -1).mean(axis=1)
    rmse = float(np.sqrt(operator.mass @ squares / operator.mass.sum()))
    peak = float(np.ptp(image.clean))
    if rmse == 0 or peak == 0:
        return {"rmse": rmse}
    return {"rmse": rmse, "psnr": float(20.0 * np.log10(peak / rmse))}


def segmentation_metrics(image: Image, operator: SurfaceOperator, segmentation: NDArray[np.bool_]) -> dict[str, float]:
    """Return "dice NAME" and "accuracy NAME" for every reference of `image.labels`, weighted by area."""
    metrics = {}
    for name, truth in image.labels.items():
        metrics[f"dice {name}"] = dice(operator.mass, segmentation, truth)
        metrics[f"accuracy {name}"] = float(operator.mass @ (segmentation == truth) / operator.mass.sum())
    return metrics


def dice(mass: Floats, first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    """Return 2 |A and B| / (|A| + |B|) by area; 1 where both are empty."""
    total = float(mass @ first.astype(float) + mass @ second.astype(float))
    return 2.0 * float(mass @ (first & second).astype(float)) / total if total > 0 else 1.0
