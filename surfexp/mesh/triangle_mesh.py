"""The triangle mesh: immutable arrays and the geometry and topology derived from them."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.edge_table import EdgeTable, half_edge_table
from surfexp.mesh.given_arrays import frozen, index_array, real_array
from surfexp.mesh.union_find import components


@dataclass(frozen=True, eq=False, repr=False)
class TriangleMesh:
    """A triangulated surface in space.

    Both arrays are read-only, and copies where whoever gave them could change them. Types, shapes and the range of indices are
    checked; `surfexp.mesh.validate` finds every other defect.

    Parameters
    ----------
    vertices : (n, 3) float64
        Positions, in the unit of the surface.
    faces : (m, 3) int64
        Vertex indices from 0, counter-clockwise seen from outside.

    Raises
    ------
    ValueError
        If an array does not hold real or whole numbers, a shape is not (n, 3), or an index lies outside 0..n-1.
    """

    vertices: Floats
    faces: Integers

    def __repr__(self) -> str:
        return f"<TriangleMesh: {len(self.vertices):,} vertices, {len(self.faces):,} faces>"

    def __post_init__(self) -> None:
        vertices = np.ascontiguousarray(real_array(self.vertices, "vertices", infinite=True))
        faces = np.ascontiguousarray(index_array(self.faces, "faces"))
        for name, array in (("vertices", vertices), ("faces", faces)):
            if array.ndim != 2 or array.shape[1] != 3:
                raise ValueError(f"{name} has shape {array.shape}, expected (count, 3)")
        if faces.size and (faces.min() < 0 or faces.max() >= len(vertices)):
            bad = int(faces.min()) if faces.min() < 0 else int(faces.max())
            raise ValueError(f"faces name vertex {bad}, but the vertices are 0..{len(vertices) - 1}")
        object.__setattr__(self, "vertices", frozen(vertices, self.vertices))
        object.__setattr__(self, "faces", frozen(faces, self.faces))

    @cached_property
    def identity(self) -> str:
        """Digest of both arrays: the same for the same vertices and faces in the same order, and for nothing else."""
        return hashlib.sha256(self.vertices.tobytes() + self.faces.tobytes()).hexdigest()

    @cached_property
    def face_cross_products(self) -> Floats:
        """(m, 3) edge cross products: normal direction, length twice the area."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    @cached_property
    def areas(self) -> Floats:
        """(m,) face areas."""
        return 0.5 * _norms(self.face_cross_products)

    @cached_property
    def area(self) -> float:
        """Total area."""
        return float(self.areas.sum())

    @cached_property
    def face_normals(self) -> Floats:
        """(m, 3) unit normals; zero on faces without area."""
        lengths = 2.0 * self.areas[:, None]
        return np.divide(self.face_cross_products, lengths, out=np.zeros((len(self.faces), 3)), where=lengths > 0)

    @cached_property
    def vertex_normals(self) -> Floats:
        """(n, 3) unit normals, the area-weighted mean over the first ring."""
        normals = np.zeros_like(self.vertices)
        for k in range(3):
            np.add.at(normals, self.faces[:, k], self.face_cross_products)
        lengths = _norms(normals)[:, None]
        return np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)

    @cached_property
    def vertex_areas(self) -> Floats:
        """(n,) a third of the area of the first ring (the lumped mass)."""
        return np.bincount(self.faces.ravel(), np.repeat(self.areas / 3.0, 3), len(self.vertices)).astype(np.float64)

    @cached_property
    def edge_length(self) -> float:
        """The side of the equilateral triangle of mean area, h = sqrt(4 mean(area) / sqrt 3)."""
        return float(np.sqrt(self.areas.mean() * 4.0 / np.sqrt(3.0)))

    @cached_property
    def edge_table(self) -> EdgeTable:
        """The edges and their half-edges: number 3 f + k runs from corner k of face f to its corner k + 1."""
        return half_edge_table(self.faces, len(self.vertices))

    @cached_property
    def edges(self) -> Integers:
        """(e, 2) undirected edges, smaller index first, sorted."""
        return self.edge_table.edges

    @cached_property
    def face_edges(self) -> Integers:
        """(m, 3) index into `edges` of the sides (0,1), (1,2), (2,0) of each face."""
        return self.edge_table.edge_of.reshape(-1, 3)

    @cached_property
    def edge_face_counts(self) -> Integers:
        """(e,) number of faces at each edge: 1 on a boundary, 2 inside, more where the mesh is not a manifold."""
        return self.edge_table.counts

    @cached_property
    def is_closed(self) -> bool:
        """Whether every edge has exactly two faces."""
        return bool(len(self.faces)) and bool((self.edge_face_counts == 2).all())

    @cached_property
    def boundary_loops(self) -> list[Integers]:
        """Vertex cycles of the boundary, in the direction of the faces, longest first."""
        directed = self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        boundary = directed[self.edge_face_counts[self.face_edges.ravel()] == 1]
        following: dict[int, list[int]] = {}
        for a, b in boundary.tolist():
            following.setdefault(a, []).append(b)
        loops = []
        while following:
            start = next(iter(following))
            loop, here = [], start
            while here in following:
                loop.append(here)
                there = following[here].pop()
                if not following[here]:
                    del following[here]
                here = there
            loops.append(np.array(loop, dtype=np.int64))
        return sorted(loops, key=len, reverse=True)

    @cached_property
    def component_labels(self) -> Integers:
        """(n,) number of the connected component of each vertex, from 0; an unreferenced vertex is one of its own."""
        return np.asarray(components(self.edges, len(self.vertices)))

    @cached_property
    def component_count(self) -> int:
        """Number of connected components that have a face."""
        return int(np.count_nonzero(np.bincount(self.component_labels[self.faces[:, 0]])))

    @cached_property
    def euler_characteristic(self) -> int:
        """Euler characteristic V - E + F over the referenced vertices."""
        return int(np.count_nonzero(np.bincount(self.faces.ravel()))) - len(self.edges) + len(self.faces)

    @cached_property
    def genus(self) -> int:
        """Sum of the genera of the components, from chi = 2 c - 2 g - b; meaningful for oriented manifolds."""
        return (2 * self.component_count - len(self.boundary_loops) - self.euler_characteristic) // 2

    @cached_property
    def minimum_angle(self) -> float:
        """Smallest angle of any face, in degrees."""
        corners = self.vertices[self.faces]
        sides = np.linalg.norm(corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]], axis=2)
        products = sides[:, [1, 2, 0]] * sides[:, [2, 0, 1]]
        cosine = (sides[:, [1, 2, 0]] ** 2 + sides[:, [2, 0, 1]] ** 2 - sides**2) / np.maximum(2.0 * products, 1e-300)
        return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)).min()))


def _norms(vectors: Floats) -> Floats:
    """(m,) lengths, also where their squares overflow or vanish."""
    largest = float(np.abs(vectors).max(initial=0.0))
    if largest == 0.0 or 1e-140 < largest < 1e140 or not np.isfinite(largest):
        return np.asarray(np.linalg.norm(vectors, axis=1))
    return np.asarray(largest * np.linalg.norm(vectors / largest, axis=1))
