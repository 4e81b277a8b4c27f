"""Still pictures of surfaces without OpenGL: the same bytes for the same arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.figures.ambient_occlusion import ambient_occlusion
from surfexp.figures.camera import Camera, View, fit_camera
from surfexp.figures.colormap import MISSING, ColorScale
from surfexp.figures.contours import RED, Contours, line_coverage
from surfexp.figures.labelling import Labelling
from surfexp.figures.lines import Lines
from surfexp.figures.rasterizer import rasterize
from surfexp.figures.shading import shade, to_display, to_linear
from surfexp.mesh.triangle_mesh import TriangleMesh

Pixels = NDArray[np.uint8]

CLAY = (0.88, 0.85, 0.81)
# colours that mean values are shaded less than clay, so that they can be read against their bar
CLAY_SHADING, VALUE_SHADING = 1.0, 0.8
CLAY_OCCLUSION, VALUE_OCCLUSION = 1.3, 0.9
# reach of the occlusion as a share of the longer side of the picture
OCCLUSION_REACH = 0.06
DARKEST_FOLD = 0.15


@dataclass(frozen=True, eq=False)
class SurfaceView:
    """A surface, its colours and the lines on it, seen from a direction.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (n,) or (n, 3) float64, optional
        A function, drawn with `scale`, or red, green and blue in 0..1. Clay when None. NaN is drawn grey.
    view : str or (float, float)
        A name of `camera.VIEWS`, "lateral", "medial", or azimuth and elevation in degrees.
    scale : ColorScale
    contours : tuple of Contours or Lines
        One over the other, in their order.
    title : str
    labels : Labelling, optional
        Flat colours, in place of values.

    Raises
    ------
    ValueError
        If values do not fit the mesh.
    """

    mesh: TriangleMesh
    values: Floats | None = None
    view: View = "oblique"
    scale: ColorScale = field(default_factory=ColorScale)
    contours: tuple[Contours | Lines, ...] = ()
    title: str = ""
    labels: Labelling | None = None

    def __post_init__(self) -> None:
        n = len(self.mesh.vertices)
        if self.values is not None and np.shape(self.values) not in ((n,), (n, 3)):
            raise ValueError(f"values have shape {np.shape(self.values)}, expected ({n},) or ({n}, 3) on this mesh")
        if self.labels is not None and self.labels.index.shape != (n,):
            raise ValueError(f"labels have shape {self.labels.index.shape}, expected ({n},) on this mesh")

    @property
    def is_scalar(self) -> bool:
        """Whether the colours stand for numbers and need a bar."""
        return self.labels is None and self.values is not None and np.ndim(self.values) == 1

    @property
    def is_coloured(self) -> bool:
        """Whether the colours mean something: numbers or labels."""
        return self.labels is not None or self.values is not None

    @property
    def missing(self) -> int:
        """Number of vertices without a finite value, drawn grey."""
        if self.labels is not None:
            return int((self.labels.index < 0).sum())
        if self.values is None:
            return 0
        return int((~np.isfinite(self.values.reshape(len(self.values), -1)).all(axis=1)).sum())


def render(
    mesh: TriangleMesh,
    values: Floats | None = None,
    *,
    view: View = "oblique",
    colormap: str = "viridis",
    limits: tuple[float, float] | None = None,
    contour_field: Floats | None = None,
    contour_levels: tuple[float, ...] = (0.0,),
    contour_color: str = RED,
    contour_width: float = 2.0,
    size: tuple[int, int] = (800, 600),
    field_of_view: float = 0.0,
    supersampling: int = 2,
) -> Pixels:
    """Picture of one surface, without text: (height, width, 3) uint8.

    Parameters are those of `SurfaceView`, `ColorScale`, `Contours` and `fit_camera`.
    """
    contours = () if contour_field is None else (Contours(contour_field, contour_levels, contour_color, contour_width),)
    scene = SurfaceView(mesh, values, view, ColorScale(colormap=colormap, limits=limits), contours)
    return draw(scene, fit_camera(mesh, view, size, field_of_view), supersampling)


def draw(scene: SurfaceView, camera: Camera, supersampling: int = 2) -> Pixels:
    """Picture of a scene under a given camera, on white.

    Parameters
    ----------
    supersampling : int
        Samples per pixel in each direction, 1 to 4.

    Raises
    ------
    ValueError
        If supersampling is not in 1..4.
    """
    from matplotlib.colors import to_rgb

    if not 1 <= supersampling <= 4:
        raise ValueError(f"supersampling is {supersampling}, choose 1 to 4 samples per pixel in each direction")
    mesh, fine = scene.mesh, camera.supersampled(supersampling)
    raster = rasterize(mesh, fine)
    if not raster.covered.any():
        return np.full((camera.size[1], camera.size[0], 3), 255, dtype=np.uint8)
    strength = VALUE_SHADING if scene.is_coloured else CLAY_SHADING
    flat = scene.labels is not None
    shaded = shade(mesh, camera, raster, *_coloring(scene), strength, supersampling, flat)
    picture = shaded.light * _visible_sky(
        scene, _nearest_of_blocks(raster.depth, supersampling), shaded.normals, camera
    )
    picture += 1.0 - shaded.coverage[:, :, None]
    for given in scene.contours:
        lines = given.lines(mesh) if isinstance(given, Contours) else given
        for color, width in lines.strokes:
            covered = line_coverage(mesh, lines, supersampling * width, fine, raster)
            share = _mean_of_blocks(covered, supersampling)[:, :, None]
            picture += share * (to_linear(np.array(to_rgb(color))) - picture)
    return to_display(picture)


def _coloring(scene: SurfaceView) -> tuple[Floats, Floats]:
    """Colours as `shade` takes them: positions in a table or linear colours at the vertices, and the table."""
    missing = to_linear(np.array([MISSING]))
    if scene.labels is not None:
        positions = (scene.labels.values + 0.5) / max(len(scene.labels.names), 1)
        return positions[:, None], np.concatenate([to_linear(scene.labels.colors), missing])
    if scene.values is None:
        return np.zeros((len(scene.mesh.vertices), 1)), np.concatenate([to_linear(np.array([CLAY])), missing])
    if not scene.is_scalar:
        return to_linear(np.asarray(scene.values, dtype=float)), missing
    scale = scene.scale.fitted(scene.values)
    return scale.position(scene.values)[:, None], np.concatenate([to_linear(scale.table()), missing])


def _visible_sky(scene: SurfaceView, depth: Floats, normals: Floats, camera: Camera) -> Floats:
    """(height, width, 1) factor that darkens folds."""
    # not mesh.edge_length, which is NaN as soon as one vertex is
    edge = 1.5 * np.sqrt(np.nanmean(scene.mesh.areas))
    hidden = ambient_occlusion(depth * camera.scale, normals, OCCLUSION_REACH * max(camera.size), edge * camera.scale)
    strength = VALUE_OCCLUSION if scene.is_coloured else CLAY_OCCLUSION
    return np.maximum(1.0 - strength * hidden, DARKEST_FOLD)[:, :, None]


def _samples_of_blocks(samples: Floats, factor: int) -> list[Floats]:
    """The factor x factor pictures of the k-th sample of each pixel."""
    return [samples[i::factor, j::factor] for i in range(factor) for j in range(factor)]


def _nearest_of_blocks(depth: Floats, factor: int) -> Floats:
    return reduce(np.minimum, _samples_of_blocks(depth, factor))


def _mean_of_blocks(samples: Floats, factor: int) -> Floats:
    return reduce(np.add, _samples_of_blocks(samples, factor)) / factor**2
