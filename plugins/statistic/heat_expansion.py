"""The heat trace and its expansion, theorem 3.1.2."""

from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.heat_expansion import heat_expansion
from surfexp.statistics.statistic import Statistic
from surfexp.workflow.registry import Options, register


class HeatExpansion(Options):
    """No option."""


@register("statistic", "heat_expansion")
def heat_expansion_statistic(options: HeatExpansion, *, surface: Surface, eigensolver: EigenSystem) -> Statistic:
    """Heat trace of a spectrum beside the printed and the corrected expansion; what of the shape is heard in it."""
    return heat_expansion(surface, eigensolver)
