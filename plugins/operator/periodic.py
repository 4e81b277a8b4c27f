"""Linear elements on a flat torus."""

from surfexp.lab.registry.registry import register
from surfexp.operators.elements_periodic import periodic_operator

register("operator", "periodic", accepts={"surface": ("flat_torus",)}, options={})(periodic_operator)
