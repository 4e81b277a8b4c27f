"""Mean curvature as an image, figure 2.8."""

import numpy as np
from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.mean_curvature import mean_curvature
from surfexp.variational.image import Image


class MeanCurvature(Options):
    """Where large curvatures are cut off.

    Curvature has a heavy tail: two means that are not robust follow the few sharpest folds. At the median of |H| what is
    left is little more than the sign, and the two means are those of sulci and gyri.
    """

    clip: float = Field(50.0, ge=10, le=100, description="percentile of |H| at which it is clipped; 100: nowhere")


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
