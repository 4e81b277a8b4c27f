"""Where a body that is no hemisphere is looked at from, when nobody says it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.camera import VIEWS, view_axes, visible_points
from surfexp.figures.lines import Lines
from surfexp.figures.render import SurfaceView
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

# rows: what points right, to the back and up; a body with y up is turned about the x axis
Z_UP, Y_UP = np.eye(3), np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
# share of the height that counts as ground; how much better the y axis must stand than the z axis
GROUND, BETTER = 0.02, 2.0
# degrees; a flat thing is seen from above where that shows so many times as much
STEP, LOW, HIGH, FLAT = 15.0, VIEWS["oblique"][1], 65.0, 1.8
# areas that differ by less are alike
ALIKE = 0.02


def upright(surface: Surface) -> Floats:
    """Return the (3, 3) rotation that stands a body up along z, as pictures have it.

    A body of which nobody says how it lies, as a scan or an animal, has y up if it stands at least twice as firmly on its
    lowest points along y as along z: by the area of the hull of the points in the lowest 2 % of its height, as a share of
    the hull of its shadow, 0 where the centre of its area is not above it. Otherwise z is up, as in brain coordinates.

    Parameters
    ----------
    surface : Surface

    Returns
    -------
    (3, 3) float64
        The identity, or the turn about the x axis that takes y to z.

    Examples
    --------
    >>> import surfexp as sx
    >>> upright(sx.shape("torus")).tolist()
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """
    if surface.frame is not None and (surface.frame.volume or surface.frame.metadata or surface.frame.transforms):
        return Z_UP
    mesh = _finite(surface.mesh)
    points, centre = visible_points(mesh), _centre(mesh)
    along_y, along_z = (_footing(points @ turn.T, turn @ centre) for turn in (Y_UP, Z_UP))
    return Y_UP if along_y > BETTER * along_z else Z_UP


def fullest_view(mesh: TriangleMesh) -> tuple[float, float]:
    """Return azimuth and elevation in degrees from which most area is seen: that of faces turned to the eye, projected.

    The elevation is that of the oblique view, 25 degrees, but 65 for what is flat: where all faces, projected, show 1.8
    times as much. The azimuth is a multiple of 15 degrees; among those within 2 % of the most it is the nearest to that of
    the oblique view. A body turned by 15 degrees about z is seen from as much.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    (float, float)
    """
    usual = VIEWS["oblique"][0]
    turns = np.arange(-180.0, 180.0, STEP)
    turns = turns[np.argsort(np.abs((turns - usual + 180.0) % 360.0 - 180.0), kind="stable")]
    low, high = (np.array([projected_areas(mesh, (turn, height)) for turn in turns.tolist()]) for height in (LOW, HIGH))
    flat = bool(high.sum(axis=1).max() > FLAT * low.sum(axis=1).max())
    turned_to_eye = (high if flat else low)[:, 0]
    first = int(np.argmax(turned_to_eye >= (1.0 - ALIKE) * turned_to_eye.max()))
    return float(turns[first]), HIGH if flat else LOW


def projected_areas(mesh: TriangleMesh, view: tuple[float, float]) -> tuple[float, float]:
    """Return the areas, as seen from a direction, of the faces that turn to the eye and of those that turn away.

    Both are the area of the shadow of a convex body.
    """
    heights = 0.5 * (mesh.face_cross_products @ view_axes(*view)[2])
    return float(np.maximum(heights, 0.0).sum()), float(np.maximum(-heights, 0.0).sum())


def standing(rows: Sequence[Sequence[SurfaceView]], surface: Surface) -> list[list[SurfaceView]]:
    """Return pictures of bodies that stand upright, with what is drawn on them, all seen from where a surface is seen best.

    Parameters
    ----------
    rows : sequence of sequences of SurfaceView
    surface : Surface
        Of several the first, so that all are seen from one side.

    Returns
    -------
    list of list of SurfaceView
    """
    rotation = upright(surface)
    turned = [[_turned(one, rotation) for one in row] for row in rows]
    view = fullest_view(_finite(turned[0][0].mesh))
    return [[replace(one, view=view) for one in row] for row in turned]


def _finite(mesh: TriangleMesh) -> TriangleMesh:
    """The faces whose corners are all somewhere; a picture leaves out the others."""
    known = np.asarray(np.isfinite(mesh.vertices).all(axis=1))
    if known.all():
        return mesh
    return TriangleMesh(np.where(known[:, None], mesh.vertices, 0.0), mesh.faces[known[mesh.faces].all(axis=1)])


def _centre(mesh: TriangleMesh) -> Floats:
    weighted = mesh.areas[:, None] * mesh.vertices[mesh.faces].mean(axis=1)
    return np.asarray(weighted.sum(axis=0) / max(mesh.areas.sum(), 1e-300))


def _footing(points: Floats, centre: Floats) -> float:
    """Area on which points stand along z, as a share of that of their shadow; 0 where they would fall."""
    from scipy.spatial import ConvexHull, QhullError

    if len(points) < 4:
        return 0.0
    heights = points[:, 2]
    ground = points[heights <= heights.min() + GROUND * np.ptp(heights), :2]
    try:
        foot, shadow = ConvexHull(ground), ConvexHull(points[:, :2])
    except (QhullError, ValueError):
        return 0.0
    stands = bool((foot.equations[:, :2] @ centre[:2] + foot.equations[:, 2] <= 0.0).all())
    return float(foot.volume / shadow.volume) if stands and shadow.volume > 0.0 else 0.0


def _turned(shown: SurfaceView, rotation: Floats) -> SurfaceView:
    if rotation is Z_UP:
        return shown
    lines = tuple(
        replace(line, points=line.points @ rotation.T) if isinstance(line, Lines) else line for line in shown.contours
    )
    vertices = np.where(np.isfinite(shown.mesh.vertices), shown.mesh.vertices, np.nan)
    return replace(shown, mesh=TriangleMesh(vertices @ rotation.T, shown.mesh.faces), contours=lines)
