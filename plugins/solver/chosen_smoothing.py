"""Ways to smooth a map whose parameter the data choose."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.parameter_choice import Rule
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.studies.smoothing.chosen_smoothing import SMOOTHING_METRICS, chosen_smoothing
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution

Method = Literal[
    "none",
    "neighbour_mean",
    "geodesic_gaussian",
    "heat_flow",
    "heat_polynomial",
    "total_variation",
    "edge_weighted_variation",
    "generalised_variation",
]


class ChosenModes(Options):
    """By what their number is chosen."""

    rule: Rule = Field("hold_out", description="what chooses the number of modes; stein if there is one repetition")
    seed: int = Field(0, ge=0, description="seed of the probe of Stein's estimate")


class ChosenSmoothing(ChosenModes):
    """Which method, and by what its parameter is chosen."""

    method: Method = Field("heat_flow", description="how the map is smoothed")
    rule: Rule = Field("hold_out", description="what chooses the parameter; stein if there is one repetition")


@register("solver", "chosen_smoothing", metrics=SMOOTHING_METRICS)
def chosen_smoothing_solver(
    options: ChosenSmoothing, *, surface: Surface, image: Image, operator: SurfaceOperator
) -> Solution:
    """A map smoothed by a method with the parameter that the data choose; columns of the image are repetitions."""
    return chosen_smoothing(surface.mesh, operator, image, options.method, options.rule, seed=options.seed)


@register("solver", "chosen_modes", metrics=SMOOTHING_METRICS)
def chosen_modes_solver(
    options: ChosenModes, *, surface: Surface, image: Image, operator: SurfaceOperator, eigensolver: EigenSystem
) -> Solution:
    """What as many of the lowest modes see of a map as the data choose; columns of the image are repetitions."""
    return chosen_smoothing(
        surface.mesh, operator, image, "truncated_modes", options.rule, eigensystem=eigensolver, seed=options.seed
    )
