"""A surface that turns: in a notebook, or as a page of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from surfexp.contract.arrays import Integers
from surfexp.contract.drawable import Drawable
from surfexp.figures.camera import View, viewing_direction
from surfexp.figures.color_bar import fitted_scales
from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.render import SurfaceView
from surfexp.io.replacing import check_writable, replacing
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.skeleton import Skeleton
from surfexp.tasks.denoising_path import DenoisingPath
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.map_columns import MOST_COLUMNS, columns_of, flat_colors, is_color, spread_over
from surfexp.tasks.map_rows import as_columns
from surfexp.tasks.path_scene import path_columns, path_scene
from surfexp.tasks.pictures import SUFFIXES, check_picture_target, picture_of
from surfexp.tasks.shown import apart, is_several, shown_surfaces, sides
from surfexp.viewer.page import viewer_page
from surfexp.viewer.scene import Drawn, Field, Scene, Step

# bytes of a page's surfaces; pixels of a row of panels in a notebook
LARGEST, ROW_HEIGHT, PANELS_ABREAST = 40_000_000, 560, 3


@dataclass(frozen=True, eq=False, repr=False)
class TurningView:
    """Surfaces that turn together, shown by notebooks as they are.

    Parameters
    ----------
    scene : Scene
    rows : tuple of tuples of SurfaceView
        The same as pictures.
    title, caption : str
    """

    scene: Scene
    rows: tuple[tuple[SurfaceView, ...], ...]
    title: str = ""
    caption: str = ""

    def html(self) -> str:
        """Return the page: it holds all that it needs, asks no host, and runs no script but the viewer's.

        Returns
        -------
        str

        Raises
        ------
        ValueError
            If the surfaces take more than 40 MB.
        """
        return viewer_page(self.scene, title=self.title, caption=self.caption, budget=LARGEST)

    def save(self, path: Path | str) -> None:
        """Write the view as .html, or its first look as .png, .svg or .pdf.

        Parameters
        ----------
        path : path

        Raises
        ------
        ValueError
            If the format is unknown.
        """
        target = Path(path)
        check_view_target(target)
        if target.suffix.lower() != ".html":
            picture_of(self.rows).save(target)
            return
        with replacing(target) as temporary:
            temporary.write_text(self.html(), encoding="utf-8")

    def __repr__(self) -> str:
        return f"<TurningView: {len(self.scene.panels)} panels of {len(self.scene.surfaces)} surfaces>"

    def _repr_html_(self) -> str:
        count = len(self.scene.panels) + (self.scene.curve is not None)
        height = ROW_HEIGHT * -(-count // PANELS_ABREAST)
        frame = f'width="100%" height="{height}" style="border:0" sandbox="allow-scripts"'
        return f'<iframe srcdoc="{escape(self.html())}" {frame} title="{escape(self.title or "surface")}"></iframe>'


def view(
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
    title: str = "",
) -> TurningView:
    """Show a surface that turns, coloured by a map or by labels; the pointer tells the value at a vertex.

    The page rounds a map to a 65,534th of its range, and the pointer tells the rounded value; where one value lies far from all
    others, it keeps all digits. Vertices have the numbers that the file gives them.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces); or a list of them
        Each is a panel, and all panels turn together. Two arrays are vertices and faces, anything else in a list a surface.
    values : str, (n,) array, `LabelMap`, or a result with `values`, optional
        A map, or labels: integers and truth values are labels. A list has one for each of several surfaces, or of one
        surface a panel for each; so has a dict, with their names. A map of several columns, as a time series, has a
        slider, and so has a denoising path; (n, 3) numbers in 0..1 are colours. Without one a scan has its own colours.
    views : name, (azimuth, elevation) in degrees, or a sequence of these
        Where panels look from at first: one for each. By default one, lateral for a hemisphere; else as in `plot`.
    colormap : str, optional
    limits : (float, float), optional
    contours : sequence of float, optional
    borders : str, `LabelMap`, (n,) whole numbers or texts, optional
    skeleton : Skeleton, optional
    label, unit : str
        These as in `plot`.
    title : str

    Returns
    -------
    TurningView
        `save(path)` writes .html, .png, .svg or .pdf.

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
    >>> seen = sx.view(sphere, sphere.mesh.vertices[:, 2], label="height")
    >>> seen, len(seen.html()) < 700_000
    (<TurningView: 1 panels of 1 surfaces>, True)
    """
    if isinstance(values, DenoisingPath):
        if any(lines is not None for lines in (contours, borders, skeleton)):
            raise ValueError("a path is shown without contours, borders and skeleton: view path.at(weight) with them")
        options = {"views": views, "colormap": colormap, "limits": limits, "label": label or values.name, "unit": unit}
        return _along(surface, values, title, options)
    several = is_several(surface)
    given = [as_surface(one) for one in (surface if several else [surface])]
    in_one = skeleton is not None or isinstance(values, Skeleton)
    owners = given if in_one else apart(given)
    hemispheres = all(owner.hemisphere in HEMISPHERES for owner in owners)
    usual = "lateral" if hemispheres else "oblique" if any(owner.hemisphere for owner in owners) else None
    if not several:
        values = as_columns(given[0], values)
    columns = [] if several or isinstance(values, Drawable) else columns_of(values)
    rows = shown_surfaces(
        given if several else given[0],
        values,
        views=views or usual,
        colormap=colormap,
        limits=limits,
        contours=contours,
        borders=borders,
        skeleton=skeleton,
        label=label,
        unit=unit,
        most_columns=max(len(columns), 1),
    )
    scene = _scene(rows[:1] if columns else rows, owners)
    if columns:
        looks, scales = len(rows[0]) // len(owners), fitted_scales([one for row in rows for one in row])
        # the first panel of a row has its name, before what it shows
        names = [row[0].title.partition(":")[0] for row in rows]
        for k, drawn in enumerate(scene.surfaces):
            drawn.fields[0] = _series(drawn, [row[k * looks] for row in rows], names, scales)
        scene.titles[:] = [title.removeprefix(names[0]).removeprefix(": ") for title in scene.titles]
    return TurningView(scene, tuple(tuple(rows[k]) for k in spread_over(len(rows), MOST_COLUMNS)), title)


def _along(surface: Any, path: DenoisingPath, title: str, options: dict[str, Any]) -> TurningView:
    """Show a path by a slider over its weights; as a picture by stills."""
    notes = dict.fromkeys((*path.risk().notes, *path.notes))
    seen = view(surface, path_columns(path), title=title, **options)
    rows = tuple(map(tuple, shown_surfaces(surface, path, **options)))
    return TurningView(path_scene(seen.scene, path), rows, title, " ".join(notes))


def check_view_target(target: Path) -> None:
    """Refuse a file that no view can be written to.

    Raises
    ------
    ValueError
        Naming the formats.
    """
    if target.suffix.lower() == ".html":
        check_writable(target)
    elif target.suffix.lower() in SUFFIXES:
        check_picture_target(target)
    else:
        raise ValueError(f"{target} has an unknown format, choose one of {', '.join(('.html', *SUFFIXES))}")


def _scene(rows: list[list[SurfaceView]], owners: Sequence[Any]) -> Scene:
    """Return each surface once with its maps, and the panels that show them."""
    everything = [one for row in rows for one in row]
    scales = fitted_scales(everything)
    looks = len(rows[0]) // len(owners)
    surfaces = [
        Drawn(owner.name, rows[0][k * looks].mesh, [], sides(owner), _origin(owner)) for k, owner in enumerate(owners)
    ]
    panels, eyes, titles = [], [], []
    for row in rows:
        for k, drawn in enumerate(surfaces):
            first = row[k * looks]
            fields = _fields(first, scales.get(first.scale, first.scale), drawn.mesh)
            place = len(drawn.fields)
            drawn.fields.extend(fields)
            for one in row[k * looks : (k + 1) * looks]:
                panels += [(k, place + j) for j in range(len(fields))]
                eyes += [viewing_direction(one.view, one.mesh)] * len(fields)
                titles += [one.title] * len(fields)
    return Scene(surfaces, panels, eyes[0], eyes, titles)


def _origin(owner: Surface) -> Integers | None:
    """The vertices of its file, of which repair has made copies."""
    if owner.file is None or len(owner.file.origin) == len(owner.file.standing):
        return None
    return owner.file.origin


def _series(drawn: Drawn, shown: list[SurfaceView], names: list[str], scales: Mapping[ColorScale, ColorScale]) -> Field:
    """Return the columns of a map as steps of one field, with its slider, in colours that all columns and surfaces share."""
    first = drawn.fields[0]
    steps = [
        replace(_fields(one, first.scale, drawn.mesh)[0].steps[0], name=name)
        for one, name in zip(shown, names, strict=True)
    ]
    return Field(first.name, tuple(steps), scales.get(shown[0].scale, first.scale), start=0)


def _fields(shown: SurfaceView, scale: Any, mesh: TriangleMesh) -> list[Field]:
    """Return the map or the labels with their lines; of several channels each."""
    lines = tuple(one.lines(mesh) if isinstance(one, Contours) else one for one in shown.contours)
    drawn = tuple(line for line in lines if len(line.segments))
    if shown.labels is not None:
        return [Field("labels", (Step(shown.labels.values, "", drawn),), labels=shown.labels)]
    if shown.values is None or shown.is_scalar:
        return [Field(scale.label or "map", (Step(shown.values, "", drawn),), scale)]
    if is_color(shown.values):
        colors = flat_colors(shown.values)
        return [Field("colours", (Step(colors.values, "", drawn),), labels=colors, legend=False)]
    return [Field(f"channel {k}", (Step(one, "", drawn),), scale) for k, one in enumerate(shown.values.T, 1)]
