"""The template by which sulci are named: its regions, those that are measured, and the map from it to a surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.functional_map import vertex_map
from surfexp.embedding.spectral_distance import sampled_signs
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.embedding.zoomout import refine_with_field, zoomout
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import EigenSystem

from .sulcal_lengths import region_ends
from .sulcal_regions import bounded_curvature, sulcal_regions

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


def make_template(surface: Surface, measured: int) -> Template:
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
        surface, sulcal_system(surface.mesh), regions, tuple(int(k) for k in chosen), tuple(ends[k] for k in chosen)
    )


def sulcal_system(mesh: TriangleMesh) -> EigenSystem:
    """The eigenpairs that `template_map` takes."""
    elements = surface_elements(mesh)
    return eigenpairs(elements.stiffness, elements.mass, MODES)


def template_map(template: Template, system: EigenSystem, mesh: TriangleMesh) -> Integers:
    """Return the template vertex of each vertex of a surface: ZoomOut, then one round with the mean curvature."""
    template_areas, areas = template.surface.mesh.vertex_areas, mesh.vertex_areas
    source, target = spectral_embedding(template.system, template_areas, 10), spectral_embedding(system, areas, 10)
    signs = np.diag(sampled_signs(source, target, samples=800)[0].astype(np.float64))
    start = vertex_map(signs, source.points, target.points)
    rows = zoomout(template.system, system, (template_areas, areas), start, 10, LARGEST_MAP, samples=2000)
    fields = bounded_curvature(template.surface.mesh), bounded_curvature(mesh)
    return refine_with_field(
        template.system, system, (template_areas, areas), rows, fields, LARGEST_MAP, iterations=FIELD_ROUNDS
    )
