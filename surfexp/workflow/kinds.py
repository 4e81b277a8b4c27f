"""Stage kinds: the result type of each, which is also the annotation by which a plugin asks for it as an input."""

from __future__ import annotations

from dataclasses import dataclass

from surfexp.figures.figure import Figure
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution


@dataclass(frozen=True)
class Kind:
    """A stage kind: its name, its result type, and whether results are stored or made again inside each job."""

    name: str
    result: type
    stored: bool = True


KINDS: dict[str, Kind] = {}


def stage_kind(name: str, result: type, stored: bool = True) -> None:
    """Declare a stage kind; `stored=False` is for cheap values such as models, which live inside the job that uses them."""
    if name in KINDS and KINDS[name].result is not result:
        raise ValueError(f"stage kind {name!r} is {KINDS[name].result.__qualname__} already")
    KINDS[name] = Kind(name, result, stored)


def kind_of(result: type) -> str:
    """Name of the kind whose result type this is; KeyError when it is none."""
    return {kind.result: kind.name for kind in KINDS.values()}[result]


stage_kind("surface", Surface)
stage_kind("image", Image)
stage_kind("operator", SurfaceOperator)
stage_kind("model", Model, stored=False)
stage_kind("solver", Solution)
stage_kind("figure", Figure)
