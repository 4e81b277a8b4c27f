"""Ways to smooth a map whose parameter the data choose."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
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


Seed = Annotated[int, Field(ge=0, description="seed of the probe of Stein's estimate")]


@register("solver", "chosen_smoothing", metrics=SMOOTHING_METRICS, defaults_of=chosen_smoothing)
def chosen_smoothing_solver(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    *,
    rule: Annotated[Rule, Field(description="what chooses the parameter; stein if there is one repetition")],
    seed: Seed,
    method: Annotated[Method, Field(description="how the map is smoothed")] = "heat_flow",
) -> Solution:
    """A map smoothed by a method with the parameter that the data choose; columns of the image are repetitions."""
    return chosen_smoothing(surface.mesh, operator, image, method, rule, seed=seed)


@register("solver", "chosen_modes", metrics=SMOOTHING_METRICS, defaults_of=chosen_smoothing)
def chosen_modes_solver(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    eigensolver: EigenSystem,
    *,
    rule: Annotated[Rule, Field(description="what chooses the number of modes; stein if there is one repetition")],
    seed: Seed,
) -> Solution:
    """What as many of the lowest modes see of a map as the data choose; columns of the image are repetitions."""
    return chosen_smoothing(surface.mesh, operator, image, "truncated_modes", rule, eigensystem=eigensolver, seed=seed)
