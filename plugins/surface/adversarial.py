"""Meshes on which eigensolvers are tried."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.modes.adversarial_meshes import coarse, side_by_side, with_slivers


class Coarse(Options):
    """How many vertices stay, and of what."""

    count: int = Field(1600, ge=20, le=1000000, description="vertices that stay")
    seed: int = Field(0, ge=0, description="seed of what is shaken before edges are contracted")
    thinnest: float | None = Field(None, ge=0, description="cut away where the map 'thickness' is less, mm")


@register("surface", "coarse")
def coarse_surface(options: Coarse, *, original: Surface) -> Surface:
    """Another surface with fewer vertices, each seed another mesh; of a cortex without its medial wall, if asked."""
    return coarse(original, **dict(options))


class SideBySide(Options):
    """How equal the two are."""

    perturbation: float = Field(0.0, ge=0, le=1, description="noise on the copy, in diameters")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("surface", "side_by_side")
def side_by_side_surface(options: SideBySide, *, original: Surface) -> Surface:
    """Another surface and its mirror image beside it as one mesh: every eigenvalue is double, or nearly."""
    return side_by_side(original, **dict(options))


class Slivers(Options):
    """How flat, and how many."""

    angle: float = Field(1e-3, gt=0, le=30, description="least angle of a sliver, degrees")
    share: float = Field(0.02, gt=0, le=1, description="share of the triangles that are flattened")
    seed: int = Field(0, ge=0, description="seed of the choice")


@register("surface", "slivers")
def slivers_surface(options: Slivers, *, original: Surface) -> Surface:
    """Another surface on which some triangles are nearly lines."""
    return with_slivers(original, **dict(options))
