"""Lengths of the template's sulci on a surface by every estimator, and the regions and names from which they come."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.surface import Surface

from .sulcal_lengths import carried_ends, closed_region, geodesic_lengths
from .sulcal_lines import LINE_ESTIMATORS, sulcal_line
from .sulcal_regions import OUTSIDE, names_by_majority, sulcal_regions
from .sulcal_template import Template, sulcal_system, template_map

TRUE, DEFAULT = "true", "carried ends"


@dataclass(frozen=True, eq=False)
class NamedSulci:
    """A surface whose sulci have the template's names.

    Parameters
    ----------
    rows : (t,) int64
        Template vertex of each vertex.
    carried : (t,) int64
        Number of the template's region that the map brings to each vertex, -1 on gyri.
    own : (t,) int64
        The surface's own regions under the template's numbers, by majority vote; -1 on gyri and where there is no name.
    """

    rows: Integers
    carried: Integers
    own: Integers


def template_rows(template: Template, target: Surface) -> Integers:
    """Return the template vertex of each vertex of a surface; only the mesh is looked at."""
    return template_map(template, sulcal_system(target.mesh), target.mesh)


def name_sulci(template: Template, target: Surface) -> NamedSulci:
    """Map a surface to the template and name its sulcal regions; only the mesh is looked at."""
    rows = template_rows(template, target)
    regions = sulcal_regions(target.mesh)
    names = names_by_majority(regions, target.mesh.vertex_areas, template.regions, rows)
    own = np.where(regions >= 0, names[regions], OUTSIDE)
    return NamedSulci(rows, template.regions[rows], own)


def measure_sulci(
    template: Template, target: Surface, named: NamedSulci | None = None, lines: bool = True
) -> dict[str, Floats]:
    """Return the lengths of the template's measured regions on a target, by estimator; NaN where none is found.

    "carried ends" is the geodesic on the surface between the ends that the map brings from the template. The others are
    those of `sulcal_line`, on the region that the map brings and on the target's own of that name, both closed by a
    ring. Where the target's true origin is known, "true" is the geodesic between the true ends. `named` is what
    `name_sulci` gave, when that is known. Without `lines` only geodesics between ends are measured.
    """
    named = named or (name_sulci(template, target) if lines else None)
    mesh, source = target.mesh, template.surface.mesh
    maps = {DEFAULT: named.rows if named else template_rows(template, target)}
    if target.truth.origin is not None:
        maps = {TRUE: target.truth.origin, **maps}
    pairs = [carried_ends(source, rows, ends) for rows in maps.values() for ends in template.ends]
    found = np.array(geodesic_lengths(mesh, pairs)).reshape(len(maps), -1)
    lengths = dict(zip(maps, found, strict=True))
    if not (named and lines):
        return lengths
    for where, regions in (("carried region", named.carried), ("own region", named.own)):
        found_lines = [_line_lengths(target, regions == number) for number in template.measured]
        for name in LINE_ESTIMATORS:
            lengths[f"{where}, {name}"] = np.array([line.get(name, np.nan) for line in found_lines])
    return lengths


def _line_lengths(target: Surface, inside: np.ndarray) -> dict[str, float]:
    try:
        return sulcal_line(target.mesh, closed_region(target.mesh, inside)).lengths
    except ValueError:
        return {}
