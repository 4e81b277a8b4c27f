"""ZoomOut: a map refined by functional maps of growing size, and a last refinement with a field on both surfaces."""

from __future__ import annotations

import numpy as np
from scipy.linalg import block_diag

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.functional_map import functional_map, vertex_map
from surfexp.spectrum.eigensystem import EigenSystem


def zoomout(
    source: EigenSystem,
    target: EigenSystem,
    areas: tuple[Floats, Floats],
    rows: Integers,
    first: int = 10,
    last: int = 80,
    step: int = 2,
    samples: int = 2000,
    seed: int = 0,
) -> Integers:
    """Refine a map by functional maps of growing size (Melzi et al. 2019), on samples of the target until the last step.

    Samples of the target are compared with all of the source: samples of both, as published, double the error, since the
    nearest of a part of the source is an edge or two from the nearest of all.

    Parameters
    ----------
    source, target : EigenSystem
        At least `last` pairs each.
    areas : tuple of (s,) and (t,) float64
        Vertex areas.
    rows : (t,) int64
        The map to begin with: source vertex of each target vertex.
    first, last, step : int
        Sizes of the functional map.
    samples : int
        Vertices of the target that take part before the last step, at least `last`.

    Returns
    -------
    (t,) int64

    Raises
    ------
    ValueError
        If there are fewer pairs or samples than `last`, or the sizes are not increasing.
    """
    most = min(len(source.values), len(target.values))
    if not 1 <= first <= last <= most or step < 1:
        raise ValueError(f"sizes {first} to {last} in steps of {step}: take 1 <= first <= last <= {most}, step >= 1")
    if samples < last:
        raise ValueError(f"{samples} samples for a functional map of size {last}: take samples >= {last}")
    first_area, second_area = float(areas[0].sum()), float(areas[1].sum())
    phi, psi = source.vectors * np.sqrt(first_area), target.vectors * np.sqrt(second_area)
    some = np.sort(np.random.default_rng(seed).choice(len(psi), min(samples, len(psi)), replace=False))
    matrix = functional_map(phi[:, :first], psi[:, :first], areas[1], rows)
    for size in range(first, last, step):
        larger = min(size + step, last)
        sampled = vertex_map(matrix, phi[:, :size], psi[some, :size])
        matrix = functional_map(phi[:, :larger], psi[some, :larger], areas[1][some], sampled)
    return vertex_map(matrix, phi[:, :last], psi[:, :last])


def refine_with_field(
    source: EigenSystem,
    target: EigenSystem,
    areas: tuple[Floats, Floats],
    rows: Integers,
    fields: tuple[Floats, Floats],
    modes: int = 60,
    share: float = 0.2,
    iterations: int = 5,
) -> Integers:
    """Refine a map in the global point embedding with one more coordinate: a field known on both surfaces.

    Parameters
    ----------
    fields : tuple of (s,) and (t,) float64
        Such as sulcal depth; brought to mean 0 and deviation 1.
    modes : int
        Size of the functional map.
    share : float
        Root mean square of the field over that of the embedding.

    Returns
    -------
    (t,) int64
    """
    most = min(len(source.values), len(target.values))
    if not 2 <= modes <= most:
        raise ValueError(f"modes = {modes}, take 2 <= modes <= {most}")
    total = float(areas[0].sum()), float(areas[1].sum())
    phi, psi = source.vectors[:, :modes] * np.sqrt(total[0]), target.vectors[:, :modes] * np.sqrt(total[1])
    weights = 1.0 / np.sqrt(np.concatenate([[1.0], target.values[1:modes] * total[1]]))
    extras = []
    for field, area in zip(fields, areas, strict=True):
        mean = field @ area / area.sum()
        spread = np.sqrt((field - mean) ** 2 @ area / area.sum())
        if not spread > 1e-9 * float(np.abs(field).max()):
            raise ValueError(f"the field is constant at {mean:g}: take one that varies")
        extras.append((field - mean) / spread)
    scale = share * float(np.sqrt(((psi * weights) ** 2).sum(axis=1).mean()))
    points = np.column_stack([phi, scale * extras[0]])
    goals = np.column_stack([psi * weights, scale * extras[1]])
    for _ in range(iterations):
        matrix = block_diag(weights[:, None] * functional_map(phi, psi, areas[1], rows), 1.0)
        previous, rows = rows, vertex_map(matrix, points, goals)
        if (rows == previous).all():
            break
    return rows
