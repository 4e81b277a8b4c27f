"""The camera: a named direction, and a scale that fits a surface into a frame."""

from __future__ import annotations

from dataclasses import dataclass, replace
from difflib import get_close_matches

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh

View = str | tuple[float, float]

# azimuth and elevation of the eye in degrees; x points right, y to the front, z up, as in brain coordinates (RAS)
VIEWS: dict[str, tuple[float, float]] = {
    "right": (0.0, 0.0),
    "left": (180.0, 0.0),
    "front": (90.0, 0.0),
    "back": (-90.0, 0.0),
    "top": (-90.0, 90.0),
    "bottom": (90.0, -90.0),
    "oblique": (-60.0, 25.0),
}
HEMISPHERE_VIEWS = ("lateral", "medial")


@dataclass(frozen=True, eq=False)
class Camera:
    """A view of space, orthographic unless the eye is at a finite distance.

    Parameters
    ----------
    axes : (3, 3) float64
        Orthonormal rows: right, up, and toward the eye.
    center : (3,) float64
        The point that the eye looks at.
    size : (int, int)
        Width and height of the frame in pixels.
    scale : float
        Pixels per unit of length at the centre.
    origin : (float, float)
        Where the centre appears, in pixels from the top left corner of the frame.
    distance : float
        From the eye to the centre; infinite for an orthographic view.
    """

    axes: Floats
    center: Floats
    size: tuple[int, int] = (1, 1)
    scale: float = 1.0
    origin: tuple[float, float] = (0.0, 0.0)
    distance: float = np.inf

    def project(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Screen positions (n, 2) in pixels, y down; depth (n,) away from the eye; perspective divisor (n,), 1 at the centre."""
        right, up, toward = self.axes @ (points - self.center).T
        divisor = 1.0 - toward / self.distance
        screen = np.stack([right, -up], axis=1) * (self.scale / divisor)[:, None] + self.origin
        return screen, -toward, divisor

    def supersampled(self, factor: int) -> Camera:
        """The same view with `factor` times as many pixels in each direction."""
        (width, height), (x, y) = self.size, self.origin
        return replace(
            self, size=(factor * width, factor * height), scale=factor * self.scale, origin=(factor * x, factor * y)
        )


def viewing_direction(view: View, mesh: TriangleMesh) -> tuple[float, float]:
    """Azimuth and elevation of the eye in degrees, seen from the centre.

    Azimuth 0 is on the x axis and 90 on the y axis; elevation 90 is on the z axis. "lateral" and "medial" look at a
    hemisphere of a brain from outside and from the mid-plane x = 0; the side is the sign of the mean of x.

    Raises
    ------
    ValueError
        If a name is unknown.
    """
    if not isinstance(view, str):
        return float(view[0]), float(view[1])
    if view in HEMISPHERE_VIEWS:
        on_the_right = bool(len(mesh.vertices)) and float(mesh.vertices[:, 0].mean()) > 0
        return VIEWS["right" if on_the_right == (view == "lateral") else "left"]
    if view not in VIEWS:
        names = [*VIEWS, *HEMISPHERE_VIEWS]
        nearest = get_close_matches(view, names, 1, 0.0)[0]
        raise ValueError(
            f"view {view!r} is unknown, choose {nearest!r} or one of {', '.join(names)}, or (azimuth, elevation)"
        )
    return VIEWS[view]


def view_axes(azimuth: float, elevation: float) -> Floats:
    """(3, 3) rows right, up and toward the eye, from angles in degrees."""
    a, e = np.radians([azimuth, elevation])
    right = [-np.sin(a), np.cos(a), 0.0]
    up = [-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)]
    toward = [np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]
    return np.array([right, up, toward])


def unit_camera(mesh: TriangleMesh, view: View = "oblique", field_of_view: float = 0.0) -> Camera:
    """Camera of scale 1 that looks at the middle of a mesh.

    Parameters
    ----------
    field_of_view : float
        Angle of perspective in degrees that the surface's diameter fills; 0 for an orthographic view, 20 is gentle.

    Raises
    ------
    ValueError
        If the view is unknown or the angle not in 0..90.
    """
    if not 0.0 <= field_of_view <= 90.0:
        raise ValueError(f"field of view is {field_of_view} degrees, choose one in 0..90")
    axes = view_axes(*viewing_direction(view, mesh))
    points = visible_points(mesh)
    if not len(points):
        return Camera(axes, np.zeros(3))
    low, high = points.min(axis=0), points.max(axis=0)
    center = 0.5 * (low + high)
    radius = max(float(np.linalg.norm(points - center, axis=1).max()), 1e-300)
    # the eye stays outside the sphere around the surface: sin, not tan
    distance = radius / np.sin(np.radians(field_of_view / 2.0)) if field_of_view else np.inf
    return Camera(axes, center, distance=distance)


def visible_points(mesh: TriangleMesh) -> Floats:
    """(k, 3) finite vertices that a face uses."""
    used = np.zeros(len(mesh.vertices), dtype=np.bool_)
    used[mesh.faces.ravel()] = True
    points = mesh.vertices[used]
    return points[np.isfinite(points).all(axis=1)]


def projected_extent(camera: Camera, mesh: TriangleMesh) -> tuple[float, float]:
    """Width and height of a surface's picture under a camera, in pixels."""
    points = visible_points(mesh)
    if not len(points):
        return 0.0, 0.0
    width, height = np.ptp(camera.project(points)[0], axis=0)
    return float(width), float(height)


def fit_camera(
    mesh: TriangleMesh,
    view: View = "oblique",
    size: tuple[int, int] = (800, 600),
    field_of_view: float = 0.0,
    margin: float = 0.03,
    scale: float | None = None,
) -> Camera:
    """Camera whose frame holds the surface, centred, with a margin.

    Parameters
    ----------
    size : (int, int)
        Width and height of the frame in pixels.
    margin : float
        Empty share of the frame's shorter side at each edge.
    scale : float, optional
        Pixels per unit of length; the largest that fits when None. Pictures of one scale compare sizes.

    Raises
    ------
    ValueError
        If the view is unknown or the frame empty.
    """
    if min(size) < 1:
        raise ValueError(f"picture size is {size[0]} x {size[1]} pixels, at least 1 x 1 is needed")
    camera = unit_camera(mesh, view, field_of_view)
    points = visible_points(mesh)
    if not len(points):
        return replace(camera, size=size)
    screen = camera.project(points)[0]
    low, high = screen.min(axis=0), screen.max(axis=0)
    if scale is None:
        room = np.array(size) - 2.0 * margin * min(size)
        scale = float(np.min(room / np.maximum(high - low, 1e-300)))
    x, y = np.array(size) / 2.0 - scale * 0.5 * (low + high)
    return replace(camera, size=size, scale=scale, origin=(float(x), float(y)))
