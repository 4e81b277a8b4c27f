"""Total variation and perimeters, theorems 2.2.1 to 2.2.3."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.statistics.statistic import Statistic
from surfexp.variational.coarea import (
    integral_of_face_perimeters,
    integral_of_perimeters,
    jump_variation,
    level_line_length,
)

METRICS = {
    "level_line_over_length": Metric("length of the level line over the exact one"),
    "indicator_over_length": Metric("total variation of the indicator at the vertices over the exact length"),
    "coarea_defect_smooth": Metric(
        "relative difference of the two sides of the co-area formula, linear on faces", better="lower"
    ),
    "coarea_defect_jumps": Metric("the same for a function constant on faces", better="lower"),
    "edge_length": Metric("mean edge length", "unit of length"),
}


@register("statistic", "coarea", accepts={"surface": ("icosphere",), "operator": ("fem",)}, metrics=METRICS)
def coarea_statistic(
    surface: Surface,
    operator: SurfaceOperator,
    *,
    angle: Annotated[float, Field(gt=0, lt=180, description="degrees from the pole to the edge of the cap")] = 63.0,
    values: Annotated[int, Field(ge=2, le=1000, description="different values of the function constant on faces")] = 40,
    seed: Annotated[int, Field(ge=0, description="seed of the function constant on faces")] = 0,
) -> Statistic:
    """Perimeter of a cap by total variation and by its level line, and both sides of the co-area formula."""
    mesh = surface.mesh
    height, level = mesh.vertices[:, 2], float(np.cos(np.radians(angle)))
    exact = 2.0 * np.pi * float(np.sin(np.radians(angle)))
    smooth = height**3 + mesh.vertices[:, 0] * mesh.vertices[:, 1]
    steps = np.random.default_rng(seed).integers(0, values, len(mesh.faces)).astype(np.float64)
    variations = total_variation(operator, smooth), jump_variation(mesh, steps)
    metrics = {
        "level_line_over_length": level_line_length(mesh, height, level) / exact,
        "indicator_over_length": total_variation(operator, (height > level).astype(np.float64)) / exact,
        "coarea_defect_smooth": abs(integral_of_perimeters(mesh, smooth) / variations[0] - 1.0),
        "coarea_defect_jumps": abs(integral_of_face_perimeters(mesh, steps) / variations[1] - 1.0),
        "edge_length": operator.edge_length,
    }
    return Statistic(f"perimeter of a cap of {angle:g} degrees", metrics=metrics)
