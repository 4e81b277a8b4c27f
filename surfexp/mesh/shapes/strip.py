"""Developable patches: a strip bent in space with jagged edges, a Y of three strips, and the bending of a flat patch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.rectangle import grid_faces
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

EQUAL_ARMS = (
    "Three equal arms: the first eigenvalue is double at every resolution and its function an accident of the mesh, "
    "with 2 or 3 extrema; take a stem above 1."
)


def strip(
    length: float = 60.0,
    width: float = 12.0,
    edge_length: float = 0.63,
    jag: float = 0.25,
    bend: float = 0.5,
    arch: float = 0.0,
    seed: int = 0,
) -> Surface:
    """A rectangle of nearly equilateral triangles with jagged long sides, rolled isometrically onto cylinders of varying radius.

    Parameters
    ----------
    length, width : float
        Sides of the flat rectangle.
    edge_length : float
        Of the triangles.
    jag : float
        Standard deviation, in edge lengths, of the boundary vertices' shift inward or outward, as manual labels have.
    bend : float
        Largest turning of the middle line, in radians over a quarter of the length; 0 leaves it flat.
    arch : float
        Curvature of the middle line within the flat strip, in radians over its whole length: an annulus sector.
    seed : int
        Of the jagged edge.

    Returns
    -------
    Surface
        `coordinates` are the flat positions (x, y).

    Raises
    ------
    ValueError
        If a size is not positive, or the strip less than four triangles wide.
    """
    if min(length, width, edge_length) <= 0 or width < 4.0 * edge_length or length < width:
        raise ValueError(
            f"strip is {length} long and {width} wide with edges of {edge_length}; width of 4 edges and length >= width needed"
        )
    rows, columns = round(width / (edge_length * 0.866)), round(length / edge_length)
    y, x = np.meshgrid(np.linspace(-0.5, 0.5, rows + 1), np.linspace(0.0, 1.0, columns + 1), indexing="ij")
    flat = np.stack([length * x.ravel(), width * y.ravel()], axis=1)
    rng = np.random.default_rng(seed)
    on_side = np.abs(y.ravel()) == 0.5
    flat[on_side, 1] += jag * edge_length * np.clip(rng.normal(size=int(on_side.sum())), -1.6, 1.6)
    inner = ~on_side & (x.ravel() > 0) & (x.ravel() < 1)
    flat[inner] += 0.15 * edge_length * rng.uniform(-1.0, 1.0, size=(int(inner.sum()), 2))
    if arch:
        radius, angle = length / arch, flat[:, 0] / length * arch
        reach = radius + flat[:, 1]
        flat = np.stack([reach * np.sin(angle), radius - reach * np.cos(angle)], axis=1)
    faces = grid_faces(rows + 1, columns + 1)[:, ::-1]
    mesh = TriangleMesh(bend_isometrically(flat, bend, length), np.ascontiguousarray(faces))
    return with_metrics(Surface(mesh, name="strip", coordinates=flat))


def bend_isometrically(flat: Floats, bend: float, scale: float) -> Floats:
    """(n, 3) positions on a general cylinder of points of a plane: lengths on the surface are those of the plane.

    The cross-section has the turning angle theta(s) = bend sin(2 pi s / scale) and the generators run along y.
    """
    s = flat[:, 0]
    fine = np.linspace(s.min(), s.max(), 4001)
    angle = bend * np.sin(2.0 * np.pi * fine / scale)
    step = fine[1] - fine[0]
    across, up = (
        np.concatenate([[0.0], np.cumsum(0.5 * (f[1:] + f[:-1]) * step)]) for f in (np.cos(angle), np.sin(angle))
    )
    return np.stack([np.interp(s, fine, across), flat[:, 1], np.interp(s, fine, up)], axis=1)


def y_patch(edge_length: float = 0.25, arm: float = 6.0, width: float = 2.0, stem: float = 1.25) -> Surface:
    """A flat patch of three arms at 120 degrees: its skeleton has three leaves.

    With three equal arms the first eigenvalue is double, whatever the resolution: its functions with three extrema and
    those with two are equally good, and which one comes out is an accident of the mesh. A longer first arm makes it simple,
    with an extremum at the end of every arm; a shorter one makes it simple with two.

    Parameters
    ----------
    edge_length, arm, width : float
        Side of the triangles; length and width of the second and the third arm.
    stem : float
        Length of the first arm over that of the others, at least 1; at 1.25 the gap to the second eigenvalue is .32 to .38
        for edges of .16 to .5, where an unsymmetric mesh of equal arms opens one of .0003 to .017.

    Returns
    -------
    Surface
        With a note where the arms are equal.

    Raises
    ------
    ValueError
        If an arm is not 1.5 times as long as wide, or less than four edges wide, or the stem is under 1.
    """
    from surfexp.mesh.shapes.planar_patch import triangulate_region

    if width < 4.0 * edge_length or arm < 1.5 * width or stem < 1.0:
        raise ValueError(
            f"arms are {arm} long, {width} wide with edges of {edge_length} and a stem of {stem:g} arms; "
            "1.5 widths, 4 edges and a stem of 1 or more are needed"
        )
    directions = [np.array([np.cos(a), np.sin(a)]) for a in (np.pi / 2, np.pi * 7 / 6, np.pi * 11 / 6)]
    lengths = (stem * arm, arm, arm)

    def inside(points: Floats) -> Integers:
        found = np.zeros(len(points), dtype=bool)
        for u, length in zip(directions, lengths, strict=True):
            along, aside = points @ u, points @ np.array([-u[1], u[0]])
            found |= (along >= 0) & (along <= length) & (np.abs(aside) <= 0.5 * width)
        return found

    reach = stem * arm
    mesh = triangulate_region(
        inside, np.array([-reach, -reach]), np.array([reach, reach]), 0.5 * edge_length, edge_length
    )
    notes = (EQUAL_ARMS,) if stem == 1.0 else ()
    return replace(with_metrics(Surface(mesh, name="Y", notes=notes)), coordinates=mesh.vertices[:, :2])
