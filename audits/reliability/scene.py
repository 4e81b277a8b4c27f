"""A small random surface with maps, labels and a mask: what a dialect has to write down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shapes.icosphere import icosphere

NAMES = ("unknown", "insula", "precentral", "cuneus", "S_calcarine")


@dataclass(frozen=True)
class Scene:
    """A surface and what lies on it.

    Parameters
    ----------
    vertices : (n, 3) float64
    polygons : list of list of int
        Corners of each face; some have more than three where `faces` cuts them.
    maps : dict of str to (n,) or (n, 3) float64
        One of them is NaN at some vertices.
    labels : (n,) int64
        Numbers of `names`.
    mask : (n,) bool
    """

    vertices: Floats
    polygons: list[list[int]]
    maps: dict[str, Floats]
    labels: Integers
    mask: NDArray[np.bool_]
    names: tuple[str, ...] = NAMES

    @property
    def triangular(self) -> bool:
        """Whether every face is a triangle."""
        return all(len(polygon) == 3 for polygon in self.polygons)

    @property
    def single(self) -> Floats:
        """The vertices rounded to single precision."""
        return self.vertices.astype(np.float32).astype(np.float64)


def random_scene(rng: np.random.Generator, triangular: bool = False) -> Scene:
    """Draw a bumpy sphere, a torus or a flat patch, numbered anew, some of its pairs of triangles joined."""
    kind = rng.choice(["sphere", "torus", "patch"])
    vertices, faces = {"sphere": _sphere, "torus": _torus, "patch": _patch}[str(kind)](rng)
    order = rng.permutation(len(vertices))
    vertices, faces = vertices[np.argsort(order)] * 10.0 ** rng.integers(-2, 3), order[faces]
    faces = faces[rng.permutation(len(faces))]
    polygons = faces.tolist() if triangular or rng.random() < 0.4 else _joined(faces, rng)
    count = len(vertices)
    depth = rng.standard_normal(count)
    gaps = np.where(rng.random(count) < 0.2, np.nan, rng.standard_normal(count))
    maps = {"depth": depth, "gaps": gaps, "flow": rng.standard_normal((count, 3))}
    return Scene(vertices, polygons, maps, rng.integers(0, len(NAMES), count), rng.random(count) < 0.7)


def _sphere(rng: np.random.Generator) -> tuple[Floats, Integers]:
    mesh = icosphere(int(rng.integers(0, 3))).mesh
    bumps = 1.0 + 0.2 * rng.random((len(mesh.vertices), 1))
    return mesh.vertices * bumps + rng.standard_normal(3), mesh.faces


def _torus(rng: np.random.Generator) -> tuple[Floats, Integers]:
    a, b = (int(k) for k in rng.integers(4, 9, 2))
    u, v = np.meshgrid(np.arange(a) * 2 * np.pi / a, np.arange(b) * 2 * np.pi / b, indexing="ij")
    ring = 2.0 + np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), np.sin(v)], axis=2).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(a), np.arange(b), indexing="ij"))
    corner = [((i + di) % a) * b + (j + dj) % b for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return vertices, np.concatenate([np.stack([corner[0], corner[k], corner[k + 1]], axis=1) for k in (1, 2)])


def _patch(rng: np.random.Generator) -> tuple[Floats, Integers]:
    from scipy.spatial import Delaunay

    points = rng.random((int(rng.integers(5, 60)), 2))
    faces = Delaunay(points).simplices.astype(np.int64)
    first, second = (points[faces[:, k]] - points[faces[:, 0]] for k in (1, 2))
    turned = first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0]
    faces[turned] = faces[turned][:, ::-1]
    used, inverse = np.unique(faces, return_inverse=True)
    return np.column_stack([points[used], np.zeros(len(used))]), inverse.reshape(faces.shape)


def _joined(faces: Integers, rng: np.random.Generator) -> list[list[int]]:
    """Join pairs of triangles at a common edge, each triangle once at most: quadrangles, concave ones among them."""
    across = {(int(f[k]), int(f[(k + 1) % 3])): (number, k) for number, f in enumerate(faces) for k in range(3)}
    taken: set[int] = set()
    polygons: list[list[int]] = []
    for number, face in enumerate(faces.tolist()):
        if number in taken:
            continue
        taken.add(number)
        k = int(rng.integers(0, 3))
        other = across.get((face[(k + 1) % 3], face[k]))
        if other is None or other[0] in taken or rng.random() < 0.5:
            polygons.append(face)
            continue
        taken.add(other[0])
        apex = int(faces[other[0]][(other[1] + 2) % 3])
        polygon = [face[k], apex, face[(k + 1) % 3], face[(k + 2) % 3]]
        polygons.append(polygon if len(set(polygon)) == 4 else face)
        if len(set(polygon)) < 4:
            polygons.append(faces[other[0]].tolist())
    return polygons
