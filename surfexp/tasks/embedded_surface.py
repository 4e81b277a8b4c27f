"""The embedding of a surface by its eigenfunctions, at area 1."""

from __future__ import annotations

from surfexp.embedding.spectral_embedding import SpectralEmbedding, Weighting, spectral_embedding
from surfexp.mesh.given_numbers import whole_number
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.lowest_pairs import lowest_pairs
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for, require_connected


def embedded(
    given: SurfaceLike, n: int, weighting: Weighting, *, name: str = "n", more: int = 0
) -> tuple[SpectralEmbedding, SurfacePart]:
    """Return the embedding of a surface by `n + more` eigenfunctions, scaled to area 1, and the part inside its mask.

    `name` is what the user calls n.
    """
    embedding, _, part = embedded_pairs(given, n, weighting, name=name, more=more)
    return embedding, part


def embedded_pairs(
    given: SurfaceLike, n: int, weighting: Weighting, *, name: str = "n", more: int = 0
) -> tuple[SpectralEmbedding, EigenSystem, SurfacePart]:
    """Return the same with the eigenpairs behind it."""
    owner = as_surface(given)
    part = part_for(owner)
    require_connected(part, "spectral distances", both=owner.right is not None)
    n = whole_number(n, name, 1, len(part.vertices) - 1 - more) + more
    _, system = lowest_pairs(Surface(part.mesh, owner.name, owner.unit), n + 1)
    return spectral_embedding(system, part.mesh.vertex_areas, n, weighting), system, part
