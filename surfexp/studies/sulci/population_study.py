"""Sulci of a synthetic population: named, measured on both sides, and compared with what was planted."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.mesh.surface import Surface
from surfexp.studies.sulci.population import Side, synthetic_subject
from surfexp.studies.sulci.sulcal_measurement import measure_sulci
from surfexp.studies.sulci.sulcal_regions import names_by_distance, names_by_majority, naming_accuracy, sulcal_regions
from surfexp.studies.sulci.sulcal_template import Template, sulcal_system, template_map

SIDES: tuple[Side, ...] = ("left", "right")
Table = dict[str, dict[Side, Floats]]


def name_regions(template: Template, target: Surface, sizes: tuple[int, ...] = (3, 4, 10, 20)) -> dict[str, float]:
    """Return the share of the target's sulcal area that is named right, by rule and number n of eigenfunctions."""
    regions, system = sulcal_regions(target.mesh), sulcal_system(target.mesh)
    areas = target.mesh.vertex_areas
    if target.truth.origin is None:
        raise ValueError(f"the true vertices of {target.name!r} are not known: take a synthetic subject")
    truth = names_by_majority(regions, areas, template.regions, target.truth.origin)
    scores = {"regions": float(regions.max() + 1)}
    template_areas = template.surface.mesh.vertex_areas
    for n in sizes:
        pair = spectral_embedding(template.system, template_areas, n), spectral_embedding(system, areas, n)
        found = spectral_distance(pair[0], pair[1], samples=800, exact=False)
        majority = names_by_majority(regions, areas, template.regions, found.correspondence)
        published = names_by_distance(
            regions, areas, found.target_points, template.regions, template_areas, found.source_points
        )
        scores[f"majority, n = {n}"] = naming_accuracy(majority, truth, regions, areas)
        scores[f"published rule, n = {n}"] = naming_accuracy(published, truth, regions, areas)
        scores[f"distance, n = {n}"] = found.value
    rows = template_map(template, system, target.mesh)
    majority = names_by_majority(regions, areas, template.regions, rows)
    return {**scores, "majority, ZoomOut": naming_accuracy(majority, truth, regions, areas)}


def measure_population(
    template: Template,
    subjects: Iterable[int],
    strain: float = 0.03,
    asymmetry: float = 0.06,
    planted: int = 0,
    seed: int = 0,
    progress: Callable[[int, float], None] | None = None,
    lines: bool = True,
) -> Table:
    """Return by estimator and side the (subjects, regions) lengths; region `planted` is longer left by `asymmetry`.

    Without `lines` only geodesics between ends are measured, see `measure_sulci`.
    """
    region, direction = template.regions == template.measured[planted], template.direction(planted)
    table: dict[str, dict[Side, list[Floats]]] = {}
    numbers = list(subjects)
    for done, subject in enumerate(numbers, 1):
        for side in SIDES:
            target = synthetic_subject(
                template.surface, subject, side, strain, region=region, asymmetry=asymmetry, direction=direction, seed=seed
            )  # fmt: skip
            for name, lengths in measure_sulci(template, target, lines=lines).items():
                table.setdefault(name, {place: [] for place in SIDES})[side].append(lengths)
        if progress is not None:
            progress(done, 1.0 - done / len(numbers))
    return {name: {side: np.array(rows) for side, rows in parts.items()} for name, parts in table.items()}
