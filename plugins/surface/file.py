"""A surface of your own."""

from pathlib import Path
from typing import Any

from pydantic import Field, model_validator

from surfexp.io.reading import read_mesh
from surfexp.io.tosca import shape_files
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import require_valid
from surfexp.workflow.registry import Options, register


class File(Options):
    """The file and its unit."""

    path: Path = Field(description="OFF, OBJ, PLY, STL, GIFTI, FreeSurfer geometry, .vert/.tri; others through open3d")
    unit: str = Field("", description="unit of length, for captions")
    faces: Path | None = Field(None, description="the .tri beside a .vert, found by itself")

    @model_validator(mode="before")
    @classmethod
    def _both_tables(cls, given: dict[str, Any]) -> dict[str, Any]:
        known = "path" in given and Path(given["path"]).is_file()
        return {**given, "faces": shape_files(Path(given["path"]))[1]} if known else given


@register("surface", "file")
def file_surface(options: File) -> Surface:
    """A mesh file of your own, with the scalar maps that it carries; refused with the repair command when defective."""
    vertices, faces, scalars = read_mesh(options.path)
    mesh = TriangleMesh(vertices, faces)
    require_valid(mesh, str(options.path))
    return Surface(mesh, options.path.stem, options.unit, scalars)
