"""Stage kinds: the result type of each, which is also the annotation by which a plugin asks for it as an input."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Kind:
    """A stage kind: its name, its result type ("module:Class"), and whether results are stored or made again in each job."""

    name: str
    path: str
    stored: bool = True

    @property
    def result(self) -> type:
        """The result type, imported when it is asked for."""
        module, _, name = self.path.partition(":")
        return getattr(importlib.import_module(module), name)


KINDS: dict[str, Kind] = {}
# what functions of the library ask for in place of a whole result, by name and type of the parameter
PARTS = {("mesh", "surfexp.mesh.triangle_mesh:TriangleMesh"): "surface"}


def path_of(result: type) -> str:
    """Return "module:Class" of a type."""
    return f"{result.__module__}:{result.__qualname__}"


def part_of(name: str, hint: Any) -> str | None:
    """Name of the kind of whose result a parameter of this name and type is a part; None when it is none."""
    return PARTS.get((name, path_of(hint))) if isinstance(hint, type) else None


def stage_kind(name: str, result: type | str, stored: bool = True) -> None:
    """Declare a stage kind; `stored=False` is for cheap values such as models, which live inside the job that uses them."""
    path = result if isinstance(result, str) else path_of(result)
    if name in KINDS and KINDS[name].path != path:
        raise ValueError(f"stage kind {name!r} is {KINDS[name].path} already")
    KINDS[name] = Kind(name, path, stored)


def kind_of(result: type) -> str:
    """Name of the kind whose result type this is; KeyError when it is none."""
    return {kind.path: kind.name for kind in KINDS.values()}[path_of(result)]


stage_kind("surface", "surfexp.mesh.surface:Surface")
stage_kind("image", "surfexp.variational.image:Image")
stage_kind("operator", "surfexp.operators.surface_operator:SurfaceOperator")
stage_kind("model", "surfexp.variational.model:Model", stored=False)
stage_kind("solver", "surfexp.variational.solution:Solution")
stage_kind("eigensolver", "surfexp.spectrum.eigensystem:EigenSystem")
stage_kind("signature", "surfexp.spectrum.signature:Signature")
stage_kind("feature", "surfexp.skeleton.feature:Feature")
stage_kind("skeleton", "surfexp.skeleton.skeleton:Skeleton")
stage_kind("distance", "surfexp.embedding.distance:Distance")
stage_kind("distance_matrix", "surfexp.statistics.distance_matrix:DistanceMatrix")
stage_kind("embedding", "surfexp.statistics.point_embedding:PointEmbedding")
stage_kind("classifier", "surfexp.statistics.classification:Classification")
stage_kind("statistic", "surfexp.statistics.statistic:Statistic")
stage_kind("figure", "surfexp.figures.figure:Figure")
