"""Size alone, the row that every classification of shapes has to beat."""

import numpy as np

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.signature import Signature

METRICS = {
    "area": Metric("area", "unit of length squared"),
}


@register("signature", "area", metrics=METRICS)
def area_signature(surface: Surface) -> Signature:
    """The area alone: how far size gets without any shape."""
    return Signature(np.array([surface.mesh.area]), "area", metrics={"area": surface.mesh.area})
