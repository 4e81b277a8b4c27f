"""Still pictures of a surface and a map on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.extras import require_installed
from surfexp.figures.camera import HEMISPHERE_VIEWS, VIEWS, View
from surfexp.figures.colormap import ColorScale
from surfexp.figures.encode import encode_png
from surfexp.figures.figure import Figure
from surfexp.figures.panel import surface_panel, vector_panel
from surfexp.figures.render import SurfaceView
from surfexp.io.replacing import check_writable, replacing
from surfexp.mesh.given_numbers import one_of, real_pair, whole_number
from surfexp.mesh.surface_part import surface_part
from surfexp.tasks.inputs import SurfaceLike, as_map, as_surface
from surfexp.tasks.soundness import usable_vertices

# pixels
NARROWEST, WIDEST = 200, 20_000
SUFFIXES = (".png", ".svg", ".pdf")


@dataclass(frozen=True, eq=False, repr=False)
class Picture:
    """A finished picture, shown by notebooks as it is.

    Parameters
    ----------
    figure : Figure
    views : tuple of SurfaceView
        What it shows, from which drawings are made; none for a picture of pixels alone.
    """

    figure: Figure
    views: tuple[SurfaceView, ...] = ()

    def save(self, path: Path | str) -> None:
        """Write the picture as .png, .svg or .pdf: drawings hold surfaces as pictures, words and colour bars as vectors.

        Parameters
        ----------
        path : path

        Raises
        ------
        ValueError
            If the format is unknown.
        """
        target = Path(path)
        check_picture_target(target)
        with replacing(target) as temporary:
            temporary.write_bytes(self._encoded(target.suffix.lower()))

    def _encoded(self, suffix: str) -> bytes:
        if suffix == ".png":
            return encode_png(self.figure.pixels)
        if self.views:
            return vector_panel(self.views, "pdf" if suffix == ".pdf" else "svg", width=self.figure.pixels.shape[1])
        if suffix == ".svg" and self.figure.svg:
            return self.figure.svg.encode()
        raise ValueError(f"a picture of pixels alone has no {suffix} drawing: choose .png")

    def __repr__(self) -> str:
        height, width = self.figure.pixels.shape[:2]
        return f"<Picture: {width} by {height} pixels>"

    def _repr_png_(self) -> bytes:
        return encode_png(self.figure.pixels)


def plot(
    surface: SurfaceLike,
    values: Any = None,
    *,
    views: Sequence[View] | None = None,
    colormap: str | None = None,
    limits: tuple[float, float] | None = None,
    label: str = "",
    unit: str = "",
    width: int = 1600,
) -> Picture:
    """Draw a surface, coloured by a map; vertices with NaN or outside the mask are grey.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
    values : str, (n,) array, or a result with `values`, optional
        Without it the surface is drawn in one colour.
    views : sequence of names or (azimuth, elevation) in degrees
        By default lateral and medial for a hemisphere, otherwise one oblique view.
    colormap : str, optional
        A name of matplotlib's; a diverging one for maps of both signs if not given.
    limits : (float, float), optional
        Ends of the colour bar; the 1st and 99th percentile if not given.
    label, unit : str
        For the colour bar.
    width : int
        In pixels.

    Returns
    -------
    Picture
        `save(path)` writes .png, .svg or .pdf.

    Raises
    ------
    ImportError
        If the extra `figures` is not installed.
    ValueError
        If the map does not fit.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> sx.plot(sphere, sphere.mesh.vertices[:, 2], width=400).figure.pixels.shape[1]
    400
    """
    width = whole_number(width, "width", NARROWEST, WIDEST)
    limits = None if limits is None else real_pair(limits, "limits")
    if limits is not None and not limits[0] < limits[1]:
        raise ValueError(f"limits = {limits}, the lower one before the upper one is needed")
    require_installed("sx.plot", "matplotlib", "PIL")
    if colormap is not None:
        from matplotlib import colormaps

        one_of(colormap, "colormap", colormaps)
    owner = as_surface(surface)
    field = None if values is None else as_map(owner, getattr(values, "values", values))
    if field is not None and field.shape[1:] == (1,):
        field = field[:, 0]
    part = surface_part(owner.mesh, usable_vertices(owner.mesh))
    if field is not None and owner.mask is not None:
        field = np.where(np.reshape(owner.mask, (-1, *[1] * (field.ndim - 1))), field, np.nan)
    chosen = [_checked_view(view) for view in views or ()]
    shown: Sequence[View] = chosen or (("lateral", "medial") if owner.hemisphere else ("oblique",))
    name = label or (values if isinstance(values, str) else "")
    scale = ColorScale(label=name, unit=unit, colormap=colormap or _colormap_for(field), limits=limits)
    if field is not None:
        field = np.asarray(part.restrict(field), dtype=np.float64)
    panels = [SurfaceView(part.mesh, field, view, scale) for view in shown]
    return Picture(surface_panel(panels, width=width), tuple(panels))


def _checked_view(given: Any) -> View:
    if given is None or isinstance(given, str | int | float):
        return one_of(given, "views", (*VIEWS, *HEMISPHERE_VIEWS))
    return real_pair(given, "views")


def _colormap_for(field: Floats | None) -> str:
    if field is None or field.ndim > 1 or not np.isfinite(field).any():
        return "viridis"
    low, high = np.nanpercentile(field, [1.0, 99.0])
    return "RdBu_r" if low < 0 < high and min(-low, high) > 0.2 * max(-low, high) else "viridis"


def check_picture_target(target: Path) -> None:
    """Refuse a file that no picture can be written to: of another format, or in no writable folder.

    Raises
    ------
    ValueError
        Naming the formats.
    """
    if target.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{target} has an unknown format, choose one of {', '.join(SUFFIXES)}")
    check_writable(target)
