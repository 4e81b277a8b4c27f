"""Shapes of the TOSCA collection, from a copy of your own."""

from pathlib import Path

import numpy as np
from pydantic import Field

from surfexp.mesh.reading import read_mesh
from surfexp.mesh.repair import repair
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import Floats, Integers
from surfexp.workflow.registry import Options, register


class Tosca(Options):
    """Where the file is."""

    path: Path = Field(description=".vert or .tri beside each other, .off, or the .mat of the original collection")


@register("surface", "tosca")
def tosca_surface(options: Tosca) -> Surface:
    """A shape of TOSCA or the like, repaired where it is defective, with a report of what was done."""
    vertices, faces = _read_mat(options.path) if options.path.suffix == ".mat" else read_mesh(options.path)[:2]
    mended = repair(vertices, faces, largest_component=True)
    metrics = {"changes": float(len(mended.changes))}
    return with_metrics(Surface(mended.mesh, options.path.stem, metrics=metrics, notes=mended.changes))


def _read_mat(path: Path) -> tuple[Floats, Integers]:
    from scipy.io import loadmat

    content = loadmat(str(path), squeeze_me=True)
    if "surface" not in content:
        raise ValueError(f"{path.name} has no variable 'surface' with X, Y, Z and TRIV, as the files of TOSCA have")
    surface = content["surface"]
    points = np.stack([np.asarray(surface[axis].item(), dtype=np.float64) for axis in "XYZ"], axis=1)
    return points, np.asarray(surface["TRIV"].item(), dtype=np.int64) - 1
