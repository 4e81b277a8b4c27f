"""Still pictures of a surface and a map on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from surfexp.figures.camera import View
from surfexp.figures.encode import exact_png
from surfexp.figures.figure import Figure
from surfexp.figures.panel import surface_panel, vector_panel
from surfexp.figures.render import SurfaceView
from surfexp.io.replacing import check_writable, replacing
from surfexp.mesh.given_numbers import whole_number
from surfexp.skeleton.skeleton import Skeleton
from surfexp.tasks.denoising_path import DenoisingPath
from surfexp.tasks.given_surface import SurfaceLike
from surfexp.tasks.shown import shown_surfaces

# maps of one surface seen from one side
ABREAST = 3
# surfaces in a row
LONGEST_ROW = 6
# pixels
NARROWEST, WIDEST = 200, 20_000
SUFFIXES = (".png", ".svg", ".pdf")


@dataclass(frozen=True, eq=False, repr=False)
class Picture:
    """A finished picture, shown by notebooks as it is.

    Parameters
    ----------
    figure : Figure
    views : tuple of tuples of SurfaceView
        What it shows, row by row, from which drawings are made; none for a picture of pixels alone.
    """

    figure: Figure
    views: tuple[tuple[SurfaceView, ...], ...] = ()

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
            return exact_png(self.figure.pixels)
        if self.views:
            return vector_panel(self.views, "pdf" if suffix == ".pdf" else "svg", width=self.figure.pixels.shape[1])
        if suffix == ".svg" and self.figure.svg:
            return self.figure.svg.encode()
        fit = ".png or .svg" if self.figure.svg else ".png"
        raise ValueError(f"a picture without a surface has no {suffix} drawing: choose {fit}")

    def __repr__(self) -> str:
        height, width = self.figure.pixels.shape[:2]
        return f"<Picture: {width} by {height} pixels>"

    def _repr_png_(self) -> bytes:
        return exact_png(self.figure.pixels)


def plot(
    surface: SurfaceLike | Sequence[SurfaceLike],
    values: Any = None,
    *,
    views: Sequence[View] | View | None = None,
    colormap: str | None = None,
    limits: tuple[float, float] | None = None,
    contours: ArrayLike | None = None,
    borders: Any = None,
    skeleton: Skeleton | None = None,
    label: str = "",
    unit: str = "",
    width: int = 1600,
) -> Picture:
    """Draw a surface, coloured by a map or by labels; what has no value or lies outside the mask is grey.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces); or a list of them
        Several stand side by side, six in a row at most, at one scale. So do the hemispheres of a surface that is both, in
        four pictures. Two arrays are vertices and faces, anything else in a list is a surface.
    values : str, (n,) array, `LabelMap`, or a result, optional
        A map, or labels: integers and truth values are labels, in flat colours with a legend; labels of a file have those
        of its table (.annot, .label.gii, .dlabel.nii). A list has one for each of
        several surfaces, or of one surface a row for each, three abreast where they are seen from one side; so has a dict,
        with their names. Of a map of several columns, as a time series, six are shown, in colours that they share; (n, 3)
        numbers in 0..1 are colours. Without a map a scan has its own colours. Eigenpairs are rows of eigenfunctions with nodal
        lines. A denoised map is shown before and after, with what was removed, a denoising path at
        three weights. A distance on
        [source, target] is shown by the colours that its correspondence carries over.
    views : name, (azimuth, elevation) in degrees, or a sequence of these
        By default lateral and medial for a hemisphere. Another body is seen from where most of it faces the eye, a little
        from above, and stands upright: with y up if it stands at least twice as firmly on that as on z, as most scans and
        animals do, and the file names no space of the brain. Views by name or angle are those of the file's axes, z up.
    colormap : str, optional
        A name of matplotlib's. If not given maps that share a bar have the same: a diverging one where they are of both
        signs, and `limits`, if any, as far from 0 on both sides.
    limits : (float, float), optional
        Ends of the colour bar; the 1st and 99th percentile if not given. The picture says what lies beyond.
    contours : sequence of float, optional
        Values of the map at which lines are drawn.
    borders : str, `LabelMap`, (n,) whole numbers or texts, optional
        Labels whose borders are drawn over the map.
    skeleton : Skeleton, optional
        Drawn through the surface.
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
    rows = shown_surfaces(
        surface,
        values,
        views=views,
        colormap=colormap,
        limits=limits,
        contours=contours,
        borders=borders,
        skeleton=skeleton,
        label=label,
        unit=unit,
    )
    if len(rows) > 1 and all(len(row) == 1 for row in rows):
        single = [row[0] for row in rows]
        abreast = ABREAST if len(single) != 4 else 2
        if isinstance(values, DenoisingPath):
            abreast = len(single)
        rows = [single[k : k + abreast] for k in range(0, len(single), abreast)]
    if len(rows) == 1 and len(rows[0]) > LONGEST_ROW:
        per_row = -(-len(rows[0]) // -(-len(rows[0]) // LONGEST_ROW))
        rows = [rows[0][k : k + per_row] for k in range(0, len(rows[0]), per_row)]
    return picture_of(rows, width)


def picture_of(rows: Sequence[Sequence[SurfaceView]], width: int = 1600) -> Picture:
    """Return rows of surfaces as a picture."""
    return Picture(surface_panel(rows, width=width), tuple(map(tuple, rows)))


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
