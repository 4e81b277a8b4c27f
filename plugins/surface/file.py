"""A surface of your own."""

from pathlib import Path

from pydantic import Field

from surfexp.mesh.reading import read_mesh
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import require_valid
from surfexp.workflow.registry import Options, register


class File(Options):
    """The file and its unit."""

    path: Path = Field(description="OFF, OBJ, PLY, STL, GIFTI, FreeSurfer geometry, .vert/.tri; others through open3d")
    unit: str = Field("", description="unit of length, for captions")


@register("surface", "file")
def file_surface(options: File) -> Surface:
    """A mesh file of your own, with the scalar maps that it carries; refused with the repair command when defective."""
    vertices, faces, scalars = read_mesh(options.path)
    mesh = TriangleMesh(vertices, faces)
    require_valid(mesh, str(options.path))
    return Surface(mesh, options.path.stem, options.unit, scalars)
