"""Distances of many surfaces to one template, one surface in memory at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, spectral_embedding
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs


def embedded(surface: Surface, n: int) -> SpectralEmbedding:
    """The global point embedding of a surface by its first n eigenfunctions."""
    elements = surface_elements(surface.mesh)
    return spectral_embedding(eigenpairs(elements.stiffness, elements.mass, n + 1), surface.mesh.vertex_areas, n)


def template_distances(
    template: Surface,
    surfaces: Iterable[Surface],
    n: int = 20,
    exact: bool = False,
    samples: int = 1500,
    progress: Callable[[int], None] | None = None,
) -> dict[str, Floats]:
    """Return the columns "distance", "lower bound" and "doubtful" (1 where samples disagree on signs or proof is missing).

    Parameters
    ----------
    template : Surface
    surfaces : iterable of Surface
        Taken one at a time; a generator keeps memory small.
    n : int
        Eigenfunctions.
    exact : bool
        Prove the signs on all points, or take those of samples.
    progress : callable, optional
        Gets the number of surfaces that are done.
    """
    source, rows = embedded(template, n), []
    for surface in surfaces:
        found = spectral_distance(source, embedded(surface, n), samples=samples, exact=exact)
        doubtful = not found.optimal if exact else bool(found.notes)
        rows.append((found.value, found.lower_bound, float(doubtful)))
        if progress is not None:
            progress(len(rows))
    table = np.array(rows).reshape(-1, 3).T
    return dict(zip(("distance", "lower bound", "doubtful"), table, strict=True))
