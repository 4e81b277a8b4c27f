"""What a page turns: surfaces, what each can be coloured by, and the panels in which they stand side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from surfexp.contract.arrays import Floats, Integers
from surfexp.figures.camera import VIEWS
from surfexp.figures.colormap import ColorScale
from surfexp.figures.labelling import Labelling
from surfexp.figures.lines import Lines
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.viewer.curve import Curve

Direction = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Step:
    """One function on a surface.

    Parameters
    ----------
    values : (n,) float64, optional
        None is the bare surface.
    name : str
    lines : tuple of Lines
        Drawn with it.
    """

    values: Floats | None
    name: str = ""
    lines: tuple[Lines, ...] = ()


@dataclass(frozen=True)
class Stop:
    """A place between two steps of a field, whose values are interpolated there.

    Parameters
    ----------
    place : float
        2.25 is a quarter of the way from the third step to the fourth.
    name : str
    """

    place: float
    name: str = ""


@dataclass(frozen=True, eq=False)
class Field:
    """Functions of one name and scale, with a slider where there are several; the bare surface where there is none.

    Parameters
    ----------
    name : str
    steps : tuple of Step
    scale : ColorScale
    labels : Labelling, optional
        The values are then indices into it.
    legend : bool
        Whether names and colours of labels stand below.
    start : int
        The function that is shown at first, where there is one; of eigenfunctions the first is constant.
    stops : tuple of Stop
        Where the slider stands, if not at the steps: it is then that of the curve of the scene.
    """

    name: str
    steps: tuple[Step, ...] = ()
    scale: ColorScale = field(default_factory=ColorScale)
    labels: Labelling | None = None
    legend: bool = True
    start: int = 1
    stops: tuple[Stop, ...] = ()


@dataclass(frozen=True, eq=False)
class Drawn:
    """A surface of a scene and what it can be coloured by; NaN is drawn grey.

    Parameters
    ----------
    name : str
    mesh : TriangleMesh
    fields : list of Field
        At least one.
    sides : dict of str to (float, float)
        Its own views by name, in degrees: "lateral" and "medial" of a hemisphere.
    origin : (n,) int64, optional
        The number under which each vertex is known, where it is another one than its place.
    """

    name: str
    mesh: TriangleMesh
    fields: list[Field]
    sides: Mapping[str, Direction] = field(default_factory=dict)
    origin: Integers | None = None


@dataclass(frozen=True, eq=False)
class Scene:
    """What a figure becomes when it is turned.

    Parameters
    ----------
    surfaces : list of Drawn
    panels : list of (int, int)
        Side by side: the surface of each, and the field that it shows at first.
    view : (float, float)
        Azimuth and elevation of the eye in degrees.
    eyes : list of (float, float)
        The same for each panel, where they differ at first.
    titles : list of str
        Of the panels, where they have some.
    curve : Curve, optional
        Drawn beside the panels, over the stops of their fields.
    """

    surfaces: list[Drawn]
    panels: list[tuple[int, int]]
    view: Direction = field(default=VIEWS["oblique"])
    eyes: list[Direction] = field(default_factory=list)
    titles: list[str] = field(default_factory=list)
    curve: Curve | None = None
