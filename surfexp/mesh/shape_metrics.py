"""The numbers that a table says about every surface."""

from __future__ import annotations

from dataclasses import replace

from surfexp.mesh.surface import Surface


def with_metrics(surface: Surface) -> Surface:
    """The surface with its metrics: vertices, faces, genus, boundary_loops, area, edge_length, minimum_angle (degrees).

    Metrics of other names stay.
    """
    mesh = surface.mesh
    counts = {"vertices": len(mesh.vertices), "faces": len(mesh.faces), "genus": mesh.genus}
    counts["boundary_loops"] = len(mesh.boundary_loops)
    sizes = {"area": mesh.area, "edge_length": mesh.edge_length, "minimum_angle": mesh.minimum_angle}
    return replace(
        surface, metrics={**surface.metrics, **{name: float(count) for name, count in counts.items()}, **sizes}
    )
