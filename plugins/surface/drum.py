"""One drum of an isospectral pair, figure 4.1."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.flat_domain import boundary_angles
from surfexp.mesh.flat_shapes import Polygon
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.studies.drums.isospectral_comparison import TILE_SHAPES
from surfexp.studies.drums.isospectral_drums import glued_drum, tile_mesh
from surfexp.studies.drums.transplantation_pairs import GORDON_WEBB_WOLPERT


@register("surface", "drum", defaults_of=tile_mesh)
def drum_surface(
    *,
    which: Annotated[
        Literal["first", "second"], Field(description="drum of the pair of Gordon, Webb and Wolpert")
    ] = "first",
    tile: Annotated[
        Literal["right_isosceles", "scalene", "obtuse"], Field(description="shape of the tile")
    ] = "right_isosceles",
    divisions: Annotated[int, Field(ge=2, le=100, description="divisions of a side of the tile")] = 14,
    grading: Annotated[float, Field(ge=1, le=6, description="exponent that draws nodes to the corners; 1: uniform")],
) -> Surface:
    """Flat drum of seven equal triangles after Gordon, Webb and Wolpert, meshed tile by tile."""
    gluing = getattr(GORDON_WEBB_WOLPERT, which)
    drum = glued_drum(gluing, TILE_SHAPES[tile], *tile_mesh(divisions, grading))
    a, b, c = np.moveaxis(drum.corners, 1, 0)
    turned = np.linalg.det(np.stack([b - a, c - a], axis=1)) < 0
    faces = np.where(turned[:, None], drum.faces[:, [0, 2, 1]], drum.faces)
    vertices = np.column_stack([drum.vertices, np.zeros(len(drum.vertices))])
    mesh = TriangleMesh(vertices, faces)
    shape = Polygon(tuple(boundary_angles(mesh).tolist()), mesh.area)
    return with_metrics(Surface(mesh, f"{which} drum", shape=shape))
