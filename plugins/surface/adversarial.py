"""Meshes on which eigensolvers are tried."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.modes.adversarial_meshes import coarse, side_by_side, with_slivers


@register("surface", "coarse", defaults_of=coarse)
def coarse_surface(
    original: Surface,
    *,
    count: Annotated[int, Field(ge=20, le=1000000, description="vertices that stay")] = 1600,
    seed: Annotated[int, Field(ge=0, description="seed of what is shaken before edges are contracted")],
    thinnest: Annotated[float | None, Field(ge=0, description="cut away where the map 'thickness' is less, mm")],
) -> Surface:
    """Another surface with fewer vertices, each seed another mesh; of a cortex without its medial wall, if asked."""
    return coarse(original, count=count, seed=seed, thinnest=thinnest)


@register("surface", "side_by_side", defaults_of=side_by_side)
def side_by_side_surface(
    original: Surface,
    *,
    perturbation: Annotated[float, Field(ge=0, le=1, description="noise on the copy, in diameters")],
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Surface:
    """Another surface and its mirror image beside it as one mesh: every eigenvalue is double, or nearly."""
    return side_by_side(original, perturbation=perturbation, seed=seed)


@register("surface", "slivers", defaults_of=with_slivers)
def slivers_surface(
    original: Surface,
    *,
    angle: Annotated[float, Field(gt=0, le=30, description="least angle of a sliver, degrees")] = 0.001,
    share: Annotated[float, Field(gt=0, le=1, description="share of the triangles that are flattened")],
    seed: Annotated[int, Field(ge=0, description="seed of the choice")],
) -> Surface:
    """Another surface on which some triangles are nearly lines."""
    return with_slivers(original, angle=angle, share=share, seed=seed)
