"""Linear elements on a flat torus."""

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_periodic import periodic_operator
from surfexp.operators.surface_operator import SurfaceOperator


@register("operator", "periodic", accepts={"surface": ("flat_torus",)})
def periodic(surface: Surface) -> SurfaceOperator:
    """Finite elements on the triangles of a flat torus as they lie in the plane modulo its periods."""
    return periodic_operator(surface)
