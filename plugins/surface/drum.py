"""One drum of an isospectral pair, figure 4.1."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.flat_domain import boundary_angles
from surfexp.mesh.flat_shapes import Polygon
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.studies.drums.isospectral_comparison import TILE_SHAPES
from surfexp.studies.drums.isospectral_drums import glued_drum, tile_mesh
from surfexp.studies.drums.transplantation_pairs import GORDON_WEBB_WOLPERT


class DrumOptions(Options):
    """Which of the two, and how it is meshed."""

    which: Literal["first", "second"] = Field("first", description="drum of the pair of Gordon, Webb and Wolpert")
    tile: Literal["right_isosceles", "scalene", "obtuse"] = Field("right_isosceles", description="shape of the tile")
    divisions: int = Field(14, ge=2, le=100, description="divisions of a side of the tile")
    grading: float = Field(2.0, ge=1, le=6, description="exponent that draws nodes to the corners; 1: uniform")


@register("surface", "drum")
def drum_surface(options: DrumOptions) -> Surface:
    """Flat drum of seven equal triangles after Gordon, Webb and Wolpert, meshed tile by tile."""
    gluing = getattr(GORDON_WEBB_WOLPERT, options.which)
    drum = glued_drum(gluing, TILE_SHAPES[options.tile], *tile_mesh(options.divisions, options.grading))
    a, b, c = np.moveaxis(drum.corners, 1, 0)
    turned = np.linalg.det(np.stack([b - a, c - a], axis=1)) < 0
    faces = np.where(turned[:, None], drum.faces[:, [0, 2, 1]], drum.faces)
    vertices = np.column_stack([drum.vertices, np.zeros(len(drum.vertices))])
    mesh = TriangleMesh(vertices, faces)
    shape = Polygon(tuple(boundary_angles(mesh).tolist()), mesh.area)
    return with_metrics(Surface(mesh, f"{options.which} drum", shape=shape))
