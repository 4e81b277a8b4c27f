"""Shapes of the TOSCA collection, from a copy of your own."""

from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, Field, ValidationInfo

from surfexp.contract.metric import Metric
from surfexp.io.reading import read_mesh
from surfexp.io.tosca import read_mat, shape_files
from surfexp.lab.registry.registry import register
from surfexp.mesh.repair import repair
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface


def _vertices(path: Path, info: ValidationInfo) -> Path:
    return shape_files(path, info.data.get("shape", ""))[0]


def _triangles(given: Path | None, info: ValidationInfo) -> Path | None:
    path = info.data.get("path")
    return given if path is None else shape_files(path)[1]


METRICS = {
    "changes": Metric("repairs of the file"),
}


@register("surface", "tosca", metrics=METRICS)
def tosca_surface(
    *,
    shape: Annotated[str, Field(description="name of the shape where the path is a folder, e.g. cat0")] = "",
    path: Annotated[
        Path,
        AfterValidator(_vertices),
        Field(description=".vert or .tri beside each other, .off, the original .mat, or a folder of such"),
    ],
    faces: Annotated[
        Path | None, AfterValidator(_triangles), Field(description="the .tri beside a .vert, found by itself")
    ] = None,
) -> Surface:
    """A shape of TOSCA or the like, repaired where it is defective, with a report of what was done."""
    vertices, triangles = read_mat(path) if path.suffix == ".mat" else read_mesh(path)[:2]
    mended = repair(vertices, triangles, largest_component=True)
    metrics = {"changes": float(len(mended.changes))}
    return with_metrics(Surface(mended.mesh, path.stem, metrics=metrics, notes=mended.changes))
