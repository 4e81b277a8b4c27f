"""Shapes of the TOSCA collection, from a copy of your own."""

from pathlib import Path
from typing import Any

from pydantic import Field, model_validator

from surfexp.contract.metric import Metric
from surfexp.io.reading import read_mesh
from surfexp.io.tosca import read_mat, shape_files
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.repair import repair
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface


class Tosca(Options):
    """Where the shape is; the files it is read from belong to what identifies a result."""

    path: Path = Field(description=".vert or .tri beside each other, .off, the original .mat, or a folder of such")
    shape: str = Field("", description="name of the shape where the path is a folder, e.g. cat0")
    faces: Path | None = Field(None, description="the .tri beside a .vert, found by itself")

    @model_validator(mode="before")
    @classmethod
    def _named_files(cls, given: dict[str, Any]) -> dict[str, Any]:
        if "path" not in given:
            return given
        path, faces = shape_files(Path(given["path"]), str(given.get("shape", "")))
        return {**given, "path": path, "faces": faces}


METRICS = {
    "changes": Metric("repairs of the file"),
}


@register("surface", "tosca", metrics=METRICS)
def tosca_surface(options: Tosca) -> Surface:
    """A shape of TOSCA or the like, repaired where it is defective, with a report of what was done."""
    vertices, faces = read_mat(options.path) if options.path.suffix == ".mat" else read_mesh(options.path)[:2]
    mended = repair(vertices, faces, largest_component=True)
    metrics = {"changes": float(len(mended.changes))}
    return with_metrics(Surface(mended.mesh, options.path.stem, metrics=metrics, notes=mended.changes))
