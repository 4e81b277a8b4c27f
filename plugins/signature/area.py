"""Size alone, the row that every classification of shapes has to beat."""

import numpy as np

from surfexp.mesh.surface import Surface
from surfexp.metric import Metric
from surfexp.spectrum.signature import Signature
from surfexp.workflow.registry import Options, register


class Area(Options):
    """No option."""


METRICS = {
    "area": Metric("area", "unit of length squared"),
}


@register("signature", "area", metrics=METRICS)
def area_signature(options: Area, *, surface: Surface) -> Signature:
    """The area alone: how far size gets without any shape."""
    return Signature(np.array([surface.mesh.area]), "area", metrics={"area": surface.mesh.area})
