"""A surface made hard to recognise: vertices in another order, turned, scaled, bent or meshed anew, with its maps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from surfexp.contract.arrays import Floats
from surfexp.mesh.edge_operations import collapse_edges, flip_edges, split_edges
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface, Truth
from surfexp.mesh.triangle_mesh import TriangleMesh


def random_rotation(seed: int) -> Floats:
    """A rotation of space, uniformly drawn."""
    matrix = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return np.asarray(matrix * np.sign(np.linalg.det(matrix)))


def disguise(
    surface: Surface,
    shuffled: bool = True,
    rotated: bool = True,
    scale: float = 1.0,
    bend: float = 0.0,
    remeshed: bool = False,
    seed: int = 0,
) -> Surface:
    """Shuffle, turn, scale, bend or mesh anew, on which a comparison by shape must not depend; scalar maps go along.

    Parameters
    ----------
    surface : Surface
    shuffled : bool
        Number the vertices in a random order.
    rotated : bool
        Turn the surface in space, at random.
    scale : float
        Factor of all lengths.
    bend : float
        Turn of one end against the other about a cross axis, in radians: nearly an isometry of a thin shape.
    remeshed : bool
        Split and contract edges, so that nearly no vertex stays; maps are those of the nearest old vertex.
    seed : int

    Returns
    -------
    Surface
        Its true origin is the vertex of `surface` that each vertex is, or is nearest to. Bent or meshed anew it has no known
        shape; turned and scaled, the shape goes along.
    """
    if not scale > 0:
        raise ValueError(f"scale = {scale:g}, take a positive one")
    mesh = surface.mesh
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
    origin = np.arange(len(vertices))
    if remeshed:
        vertices, faces = _meshed_anew(mesh)
        origin = cKDTree(mesh.vertices).query(vertices)[1]
    rng = np.random.default_rng(seed)
    if shuffled:
        order = rng.permutation(len(vertices))
        place = np.argsort(order)
        vertices, origin = vertices[order], origin[order]
        faces = place[faces][rng.permutation(len(faces))]
    rotation = random_rotation(seed) if rotated else np.eye(3)
    vertices = scale * _bent(vertices, bend)
    if rotated:
        vertices = vertices @ rotation.T
    kept = surface.shape if bend == 0.0 and not remeshed else None
    labels = surface.truth.labels
    changed = replace(
        surface,
        mesh=TriangleMesh(vertices, faces),
        scalars={name: values[origin] for name, values in surface.scalars.items()},
        coordinates=None,
        metrics={},
        shape=None if kept is None else kept.similar(scale, rotation),
        truth=Truth(None if labels is None else labels[origin], origin, mesh.identity),
    )
    return with_metrics(changed)


def _meshed_anew(mesh: TriangleMesh) -> tuple[Floats, np.ndarray]:
    count, edge = len(mesh.vertices), mesh.edge_length
    vertices, faces = split_edges(np.array(mesh.vertices), np.array(mesh.faces), 0.7 * edge, 3 * count)
    for _ in range(20):
        excess = len(vertices) - count
        if excess <= 0:
            break
        vertices, faces = collapse_edges(vertices, faces, np.inf, 2.5 * edge, excess)
        faces = flip_edges(vertices, faces)[0]
    return vertices, faces


def _bent(vertices: Floats, angle: float) -> Floats:
    """Roll the longest axis of the box into an arc of the angle given; lengths on the middle plane stay."""
    if angle == 0.0:
        return vertices
    extent = np.ptp(vertices, axis=0)
    along, across = np.argsort(extent)[[2, 0]]
    middle = 0.5 * (vertices.max(axis=0) + vertices.min(axis=0))
    radius = extent[along] / angle
    turn = (vertices[:, along] - middle[along]) / radius
    height = radius + vertices[:, across] - middle[across]
    result = vertices.copy()
    result[:, along], result[:, across] = height * np.sin(turn), height * np.cos(turn)
    return result
