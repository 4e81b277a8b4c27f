"""Sulci of a synthetic population: named, measured on both sides, and compared with what was planted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from surfexp.embedding.functional_map import refine_with_field, zoomout
from surfexp.embedding.nearest import nearest
from surfexp.embedding.population import Side, synthetic_subject
from surfexp.embedding.spectral_distance import sampled_signs, spectral_distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.embedding.sulcal_lengths import carried_length, geodesic_length, region_ends
from surfexp.embedding.sulcal_regions import (
    bounded_curvature,
    names_by_distance,
    names_by_majority,
    naming_accuracy,
    sulcal_regions,
)
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import Floats, Integers, TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import EigenSystem

ESTIMATORS = ("true", "carried ends", "region ends")
MODES, LARGEST_MAP, FIELD_ROUNDS = 61, 60, 1


@dataclass(frozen=True, eq=False)
class Template:
    """A hemisphere with its regions, those that are measured, their ends, and its eigenpairs."""

    surface: Surface
    system: EigenSystem
    regions: Integers
    measured: tuple[int, ...]
    ends: tuple[tuple[int, int], ...]

    def direction(self, planted: int) -> Floats:
        """From one end to the other of a measured region."""
        start, end = self.ends[planted]
        return np.asarray(self.surface.mesh.vertices[end] - self.surface.mesh.vertices[start])


def make_template(surface: Surface, measured: int = 3) -> Template:
    """Return a template with its `measured` regions of longest extent, the longest first."""
    regions = sulcal_regions(surface.mesh)
    count = int(regions.max()) + 1
    if not 1 <= measured <= count:
        raise ValueError(f"{measured} regions are to be measured, the template has {count}: take 1 to {count}")
    ends = [region_ends(surface.mesh, regions == k) for k in range(count)]
    vertices = surface.mesh.vertices
    extents = np.array([np.linalg.norm(vertices[a] - vertices[b]) for a, b in ends])
    chosen = np.argsort(-extents, kind="stable")[:measured]
    return Template(
        surface, _system(surface.mesh), regions, tuple(int(k) for k in chosen), tuple(ends[k] for k in chosen)
    )


def _system(mesh: TriangleMesh) -> EigenSystem:
    elements = surface_elements(mesh)
    return eigenpairs(elements.stiffness, elements.mass, MODES)


def name_regions(template: Template, target: Surface, sizes: tuple[int, ...] = (4, 10)) -> dict[str, float]:
    """Return the share of the target's sulcal area that is named right, by rule and number n of eigenfunctions."""
    regions, system = sulcal_regions(target.mesh), _system(target.mesh)
    areas = target.mesh.vertex_areas
    truth = names_by_majority(regions, areas, template.regions, target.scalars["origin"].astype(np.int64))
    scores = {"regions": float(regions.max() + 1)}
    template_areas = template.surface.mesh.vertex_areas
    for n in sizes:
        pair = spectral_embedding(template.system, template_areas, n), spectral_embedding(system, areas, n)
        found = spectral_distance(pair[0], pair[1], samples=800, exact=False)
        majority = names_by_majority(regions, areas, template.regions, found.correspondence)
        printed = names_by_distance(
            regions, areas, found.target_points, template.regions, template_areas, found.source_points
        )
        scores[f"majority, n = {n}"] = naming_accuracy(majority, truth, regions, areas)
        scores[f"printed rule, n = {n}"] = naming_accuracy(printed, truth, regions, areas)
        scores[f"distance, n = {n}"] = found.value
    rows = _refined(template, system, target.mesh)
    majority = names_by_majority(regions, areas, template.regions, rows)
    return {**scores, "majority, ZoomOut": naming_accuracy(majority, truth, regions, areas)}


def _refined(template: Template, system: EigenSystem, mesh: TriangleMesh) -> Integers:
    template_areas, areas = template.surface.mesh.vertex_areas, mesh.vertex_areas
    source, target = spectral_embedding(template.system, template_areas, 10), spectral_embedding(system, areas, 10)
    start = nearest(target.points * sampled_signs(source, target, samples=800)[0], source.points)[0]
    rows = zoomout(template.system, system, (template_areas, areas), start, 10, LARGEST_MAP, samples=2000)
    fields = bounded_curvature(template.surface.mesh), bounded_curvature(mesh)
    return refine_with_field(
        template.system, system, (template_areas, areas), rows, fields, LARGEST_MAP, iterations=FIELD_ROUNDS
    )


def measure_subject(template: Template, target: Surface) -> dict[str, Floats]:
    """Return the lengths of the template's measured regions on a target, by estimator; NaN where none is found.

    "true" uses the known origin of the vertices; "carried ends" the map, and the geodesic between the ends that it finds;
    "region ends" the target's own region of that name and the extremes of its first eigenfunction.
    """
    system, mesh = _system(target.mesh), target.mesh
    areas = mesh.vertex_areas
    rows, regions = _refined(template, system, target.mesh), sulcal_regions(target.mesh)
    names = names_by_majority(regions, areas, template.regions, rows)
    origin = target.scalars["origin"].astype(np.int64)
    lengths: dict[str, list[float]] = {name: [] for name in ESTIMATORS}
    for number, ends in zip(template.measured, template.ends, strict=True):
        lengths["true"].append(carried_length(mesh, template.surface.mesh, origin, ends))
        lengths["carried ends"].append(carried_length(mesh, template.surface.mesh, rows, ends))
        own = np.isin(regions, np.flatnonzero(names == number)) & (regions >= 0)
        try:
            lengths["region ends"].append(geodesic_length(mesh, *region_ends(mesh, own)))
        except ValueError:
            lengths["region ends"].append(np.nan)
    return {name: np.array(values) for name, values in lengths.items()}


def measure_population(
    template: Template,
    subjects: int,
    strain: float = 0.03,
    asymmetry: float = 0.06,
    planted: int = 0,
    seed: int = 0,
    progress: Callable[[int, float], None] | None = None,
) -> dict[str, dict[Side, Floats]]:
    """Return by estimator and side the (subjects, regions) lengths; region `planted` is longer left by `asymmetry`."""
    sides: tuple[Side, ...] = ("left", "right")
    region, direction = template.regions == template.measured[planted], template.direction(planted)
    table: dict[str, dict[Side, list[Floats]]] = {name: {side: [] for side in sides} for name in ESTIMATORS}
    for subject in range(subjects):
        for side in sides:
            target = synthetic_subject(
                template.surface,
                subject,
                side,
                strain,
                region=region,
                asymmetry=asymmetry,
                direction=direction,
                seed=seed,
            )
            for name, lengths in measure_subject(template, target).items():
                table[name][side].append(lengths)
        if progress is not None:
            progress(subject + 1, 1.0 - (subject + 1) / subjects)
    return {name: {side: np.array(rows) for side, rows in parts.items()} for name, parts in table.items()}
