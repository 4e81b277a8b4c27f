"""Mean curvature as an image, figure 2.8."""

import numpy as np
from pydantic import Field

from surfexp.mesh.surface import Surface
from surfexp.operators.mean_curvature import mean_curvature
from surfexp.variational.image import Image
from surfexp.workflow.registry import Options, register


class MeanCurvature(Options):
    """Where large curvatures are cut off."""

    clip: float = Field(99.0, gt=50, le=100, description="percentile of |H| at which outliers are clipped")


@register("image", "mean_curvature")
def mean_curvature_image(options: MeanCurvature, *, surface: Surface) -> Image:
    """Mean curvature, positive in sulci, clipped at a percentile; FreeSurfer's maps, where there are any, are labels."""
    curvature = -mean_curvature(surface.mesh)
    bound = float(np.percentile(np.abs(curvature), options.clip))
    labels = {name: surface.scalars[name] > 0 for name in ("sulc", "curv") if name in surface.scalars}
    unit = f"1/{surface.unit}" if surface.unit else ""
    notes = (f"mean curvature is clipped at ±{bound:.3g} {unit}, the {options.clip:g}th percentile of its size",)
    return Image(
        np.clip(curvature, -bound, bound), "mean curvature (positive in sulci)", unit, labels=labels, notes=notes
    )
