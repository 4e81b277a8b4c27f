"""Mean curvature as an image, figure 2.8."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.mean_curvature import mean_curvature
from surfexp.variational.image import Image


@register("image", "mean_curvature")
def mean_curvature_image(
    surface: Surface,
    *,
    clip: Annotated[
        float, Field(ge=10, le=100, description="percentile of |H| at which it is clipped; 100: nowhere")
    ] = 50.0,
) -> Image:
    """Mean curvature, positive in sulci, clipped at a percentile; FreeSurfer's maps, where there are any, are labels."""
    curvature = -mean_curvature(surface.mesh)
    bound = float(np.percentile(np.abs(curvature), clip))
    labels = {name: surface.scalars[name] > 0 for name in ("sulc", "curv") if name in surface.scalars}
    unit = f"1/{surface.unit}" if surface.unit else ""
    notes = (f"mean curvature is clipped at ±{bound:.3g} {unit}, the {clip:g}th percentile of its size",)
    return Image(
        np.clip(curvature, -bound, bound), "mean curvature (positive in sulci)", unit, labels=labels, notes=notes
    )
