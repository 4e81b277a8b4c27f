"""A surface as an experiment sees it: a mesh with a name, a unit, scalar maps, and what is known of it for certain."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.metric import Metric
from surfexp.contract.summary import Summarized, Summary
from surfexp.mesh.file_vertices import FileVertices
from surfexp.mesh.given_arrays import frozen, map_array, mask_array
from surfexp.mesh.given_numbers import one_of
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.smooth_shape import SmoothShape
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface_part import SurfacePart
from surfexp.mesh.triangle_mesh import TriangleMesh

HEMISPHERES = ("left", "right")
BOTH = "both"


@dataclass(frozen=True, eq=False)
class Truth:
    """What the maker of a surface knows and a method has to find.

    Parameters
    ----------
    labels : (n,) int64, optional
        The region of each vertex, numbered alike on all surfaces that are compared; 0 is none.
    origin : (n,) int64, optional
        The vertex of the template that each vertex is, or is nearest to.
    template : str
        `TriangleMesh.identity` of the template that `origin` counts on.
    midline : (s, 3) float64, optional
        The line along which a patch was laid out.
    """

    labels: Integers | None = None
    origin: Integers | None = None
    template: str = ""
    midline: Floats | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Surface(Summarized):
    """A mesh with what is known about it.

    Parameters
    ----------
    mesh : TriangleMesh, or (vertices, faces)
    name : str
        What a caption calls it; nothing else hangs on it.
    unit : str
        Unit of length, empty when there is none.
    scalars : dict of str to (n,) float64
        Maps that came with the surface (curvature, sulcal depth, ground truth). What a masked array hides is NaN.
    coordinates : (n, d) float64, optional
        The parameters from which a generator made the vertices (longitude, latitude, ...), for painting pictures.
    metrics : dict of str to float
        Numbers for the table.
    notes : tuple of str
        What was repaired or lost on the way here, one sentence each.
    shape : SmoothShape, optional
        The smooth surface that all vertices lie on; checked. None for every surface whose smooth shape nobody vouches for.
    truth : Truth
        Ground truth, where there is some.
    mask : (n,) bool, or numbers of which 0 and NaN are outside, optional
        The part that methods work on, such as the cortex without its medial wall; None is all of it.
    hemisphere : {"", "left", "right", "both"}
        Where the file said so; "both" where `right` is given.
    labels : dict of str to LabelMap
        Parcellations by name.
    part : SurfacePart, optional
        What of a larger surface this mesh is, where a mask has cut it out.
    frame : SpatialFrame
        Where the vertices lie, as the file says it; written again where a format holds it.
    file : FileVertices, optional
        The vertices of its file, where repair has merged or split some. Results are written on these.
    right : (n,) bool, optional
        Of a surface that is both hemispheres: which vertices are of the right one. No face joins the two.

    Raises
    ------
    ValueError
        If the mesh is none, a map, labels, a mask or a truth is not one number a vertex, vertices lie off the shape, or a
        hemisphere is said that `right` contradicts.

    Examples
    --------
    >>> import surfexp as sx
    >>> ball = sx.shape("icosphere", levels=2).mesh
    >>> height = ball.vertices[:, 2]
    >>> upper = sx.Surface(ball, "ball", "mm", {"height": height}, mask=height > 0)
    >>> upper.scalars["height"].shape, upper.unit
    ((162,), 'mm')
    """

    mesh: TriangleMesh
    name: str = "surface"
    unit: str = ""
    scalars: dict[str, Floats] = field(default_factory=dict)
    coordinates: Floats | None = None
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    shape: SmoothShape | None = None
    truth: Truth = Truth()
    mask: NDArray[np.bool_] | None = None
    hemisphere: str = ""
    labels: dict[str, LabelMap] = field(default_factory=dict)
    part: SurfacePart | None = None
    frame: SpatialFrame = field(default_factory=SpatialFrame)
    file: FileVertices | None = None
    right: NDArray[np.bool_] | None = None
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
        if isinstance(self.mesh, tuple | list) and len(self.mesh) == 2:
            object.__setattr__(self, "mesh", TriangleMesh(*self.mesh))
        if not isinstance(self.mesh, TriangleMesh):
            raise ValueError(f"mesh is a {type(self.mesh).__name__}, a TriangleMesh or (vertices, faces) is needed")
        n = len(self.mesh.vertices)
        if self.right is not None:
            object.__setattr__(self, "right", frozen(mask_array(self.right, n, "right"), self.right))
            object.__setattr__(self, "hemisphere", self.hemisphere or BOTH)
        if self.hemisphere != "":
            one_of(self.hemisphere, "hemisphere", HEMISPHERES if self.right is None else (BOTH,))
        for name, numbers in (("labels", self.truth.labels), ("origin", self.truth.origin)):
            if numbers is not None and np.shape(numbers) != (n,):
                raise ValueError(f"true {name} have shape {np.shape(numbers)}, the mesh has {n} vertices")
        if self.shape is not None and not self.shape.holds(self.mesh):
            raise ValueError(f"the vertices of {self.name!r} do not lie on a {self.shape.words}: give shape=None")
        if self.mask is not None:
            object.__setattr__(self, "mask", frozen(mask_array(self.mask, n), self.mask))
        for name, table in self.labels.items():
            if len(table.keys) != n:
                raise ValueError(f"labels {name!r} have {len(table.keys)} entries, the mesh has {n} vertices")
        maps = {}
        for name, given in self.scalars.items():
            values = map_array(given, f"scalar map {name!r}")
            if values.shape != (n,):
                raise ValueError(f"scalar map {name!r} has shape {values.shape}, the mesh has {n} vertices")
            maps[name] = frozen(values, given)
        object.__setattr__(self, "scalars", maps)

    @property
    def vertices(self) -> Floats:
        """(n, 3) float64 positions: those of `mesh`."""
        return self.mesh.vertices

    @property
    def faces(self) -> Integers:
        """(m, 3) int64 vertices of the triangles: those of `mesh`."""
        return self.mesh.faces

    def hemispheres(self) -> dict[str, Surface]:
        """Return the two hemispheres, each as a surface of its own with its maps, labels and mask.

        Returns
        -------
        dict of str to Surface
            "left" and "right"; of a surface that is not both, itself under the hemisphere that it says.
        """
        if self.right is None:
            return {self.hemisphere: self}
        return {side: self._half(side, self.right == (side == "right")) for side in HEMISPHERES}

    def by_hemisphere(self, values: ArrayLike) -> dict[str, NDArray[Any]]:
        """Return the rows of a map for each hemisphere, as nilearn's SurfaceImage takes them.

        Parameters
        ----------
        values : (n, ...) array_like

        Returns
        -------
        dict of str to (l, ...) or (r, ...) array
            "left" and "right"; of a surface that is not both, the map under the hemisphere that it says.

        Raises
        ------
        ValueError
            If there is not one row for each vertex.
        """
        rows = np.asarray(values)
        if rows.shape[:1] != (len(self.mesh.vertices),):
            raise ValueError(f"map has shape {rows.shape}, the surface has {len(self.mesh.vertices)} vertices")
        if self.right is None:
            return {self.hemisphere: rows}
        return {side: rows[self.right == (side == "right")] for side in HEMISPHERES}

    def _half(self, side: str, inside: NDArray[np.bool_]) -> Surface:
        number = np.cumsum(inside) - 1
        faces = self.mesh.faces[inside[self.mesh.faces].all(axis=1)]
        return replace(
            self,
            mesh=TriangleMesh(self.mesh.vertices[inside], number[faces]),
            scalars={name: values[inside] for name, values in self.scalars.items()},
            coordinates=None if self.coordinates is None else self.coordinates[inside],
            metrics={},
            shape=None,
            truth=Truth(),
            mask=None if self.mask is None else self.mask[inside],
            hemisphere=side,
            labels={name: replace(table, keys=table.keys[inside]) for name, table in self.labels.items()},
            part=None,
            file=None if self.file is None else self.file.of(inside),
            right=None,
        )

    def deformed(self, mesh: TriangleMesh) -> Surface:
        """Return the surface with its vertices moved: of the same connectivity, but of no known shape and midline.

        Parameters
        ----------
        mesh : TriangleMesh
            Of the same faces.

        Returns
        -------
        Surface
        """
        return replace(self, mesh=mesh, shape=None, part=None, truth=replace(self.truth, midline=None))

    def _summary(self) -> Summary:
        size = f" {self.unit}²" if self.unit else ""
        facts = {
            "vertices": len(self.mesh.vertices),
            "faces": len(self.mesh.faces),
            "area": f"{self.mesh.area:.4g}{size}",
            "components": self.mesh.component_count,
            "boundary loops": len(self.mesh.boundary_loops),
            "inside the mask": None if self.mask is None else int(self.mask.sum()),
            "hemisphere": self.hemisphere,
            "maps": ", ".join(self.scalars),
            "labels": ", ".join(self.labels),
        }
        return Summary(self.name, facts, self.notes)
