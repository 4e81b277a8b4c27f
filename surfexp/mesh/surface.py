"""A surface as an experiment sees it: a mesh with a name, a unit and scalar maps."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from surfexp.mesh.triangle_mesh import Floats, TriangleMesh
from surfexp.metric import Metric


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh with what is known about it.

    Parameters
    ----------
    mesh : TriangleMesh
    name : str
        What a caption calls it.
    unit : str
        Unit of length, empty when there is none.
    scalars : dict of str to (n,) float64
        Maps that came with the surface (curvature, sulcal depth, ground truth).
    coordinates : (n, d) float64, optional
        The parameters from which a generator made the vertices (longitude, latitude, ...), for painting pictures.
    metrics : dict of str to float
        Numbers for the table.
    notes : tuple of str
        What was repaired or lost on the way here, one sentence each.
    """

    mesh: TriangleMesh
    name: str = "surface"
    unit: str = ""
    scalars: dict[str, Floats] = field(default_factory=dict)
    coordinates: Floats | None = None
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "vertices": Metric("number of vertices"),
        "faces": Metric("number of faces"),
        "genus": Metric("number of handles"),
        "boundary_loops": Metric("number of boundary loops"),
        "area": Metric("area", "unit of length squared"),
        "edge_length": Metric("mean length of the edges", "unit of length"),
        "minimum_angle": Metric("smallest angle of all triangles", "degrees", "higher"),
    }

    def __post_init__(self) -> None:
        n = len(self.mesh.vertices)
        for name, values in self.scalars.items():
            if np.shape(values) != (n,):
                raise ValueError(f"scalar map {name!r} has shape {np.shape(values)}, the mesh has {n} vertices")
