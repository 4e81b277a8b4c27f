"""What a map says about its noise before it is denoised: its level in spite of ties, and outliers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.noise_level import NORMAL_MEDIAN, affine_relations, noise_level

TIED = 0.05
ROUNDING = 1e-12
NEAREST = 3
# levels; what is 3 standard deviations from its neighbourhood has three neighbours nearer than this
FAR = 3.0
FEW_OUTLIERS = 0.002


@dataclass(frozen=True, eq=False)
class NoiseReading:
    """The noise of a map.

    Parameters
    ----------
    level : float
        Standard deviation, in the unit of the map; 0 only for a map that is affine wherever it varies.
    step : float
        Of a map that is rounded; 0 where it is not.
    tied : float
        Share of the pairs of triangles on which the map is affine to rounding.
    outliers : (k,) int64
        Vertices whose value is far from that of all their neighbours.
    notes : tuple of str
        The same in words, where there is something to be said.
    """

    level: float
    step: float
    tied: float
    outliers: Integers
    notes: tuple[str, ...] = ()


def read_noise(operator: SurfaceOperator, values: Floats, seed: int = 0) -> NoiseReading:
    """Read the noise from a map: as `noise_level` where few values are tied.

    A rounded map is dithered by half a step, for then the deviations are continuous again, and the variance of the
    dither is taken off; its noise counts as not less than that of rounding. In a map that is constant on a large part the
    level is that of the rest.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) float64
    seed : int
        Of the dither.

    Raises
    ------
    ValueError
        If the surface has under 20 pairs of neighbouring triangles.
    """
    plain = noise_level(operator, values)
    corners, relations = affine_relations(operator)
    sizes = np.abs(np.einsum("ek,ek->e", relations, values[corners]))
    free = sizes > ROUNDING * np.abs(values).max(initial=0.0)
    found = NoiseReading(plain, 0.0, float(1.0 - free.mean()), np.empty(0, dtype=np.int64))
    if found.tied >= TIED and free.any():
        found = _of_tied_map(operator, values, found, float(np.median(sizes[free])) / NORMAL_MEDIAN, seed)
    elif found.tied < TIED:
        found = replace(found, outliers=outliers(operator, values, plain))
    return _with_words(found, len(values))


def outliers(operator: SurfaceOperator, values: Floats, level: float) -> Integers:
    """Return the vertices from whose value the three nearest ones within two rings are three levels away, in the mean.

    At an edge of the map a vertex has neighbours on its own side; an outlier has none that is near.
    """
    ends = operator.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    ring = csr_array((np.ones(len(ends)), ends.T), shape=2 * (len(values),))
    ring = ring + ring.T
    pairs = np.column_stack((ring + ring @ ring).nonzero())
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    sizes = np.abs(values[pairs[:, 0]] - values[pairs[:, 1]])
    order = np.lexsort([sizes, pairs[:, 0]])
    owner, sizes = pairs[order, 0], sizes[order]
    counts = np.bincount(owner, minlength=len(values))
    place = np.arange(len(owner)) - (np.cumsum(counts) - counts)[owner]
    near = place < NEAREST
    means = np.bincount(owner[near], sizes[near], len(values)) / np.maximum(np.minimum(counts, NEAREST), 1)
    return np.flatnonzero(means > FAR * level)


def without_outliers(operator: SurfaceOperator, values: Floats, places: Integers) -> Floats:
    """Return the map with each of these values replaced by the median of its neighbours that are none of them.

    Where all neighbours are, those that were replaced before it count.
    """
    ends = operator.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    ring = csr_array((np.ones(2 * len(ends)), np.concatenate([ends, ends[:, ::-1]]).T), shape=2 * (len(values),))
    filled, left = values.copy(), np.zeros(len(values), dtype=bool)
    left[places] = True
    while left.any():
        good = ~left
        for vertex in np.flatnonzero(left):
            near = ring.indices[ring.indptr[vertex] : ring.indptr[vertex + 1]]
            if good[near].any():
                filled[vertex] = np.median(filled[near[good[near]]])
                left[vertex] = False
        if np.array_equal(left, ~good):
            break
    return filled


def _of_tied_map(
    operator: SurfaceOperator, values: Floats, found: NoiseReading, rest: float, seed: int
) -> NoiseReading:
    distinct = np.unique(values)
    if 2 * len(distinct) > (1.0 - found.tied) * len(values):
        return replace(found, level=rest)
    step = float(np.median(np.diff(distinct)))
    dither = step * (np.random.default_rng(seed).random(len(values)) - 0.5)
    variance = noise_level(operator, values + dither) ** 2 - step**2 / 12.0
    return replace(found, level=float(np.sqrt(max(variance, step**2 / 12.0))), step=step)


def _with_words(found: NoiseReading, count: int) -> NoiseReading:
    notes = []
    if found.step:
        notes.append(
            f"The map is rounded to steps of {found.step:.3g}: its noise counts as not less than that of rounding. Labels "
            "are no map to denoise."
        )
    elif found.tied >= TIED:
        notes.append(
            f"The map is constant or affine on {100 * found.tied:.0f} % of the surface: the noise is that of the rest."
        )
    if len(found.outliers) > FEW_OUTLIERS * count:
        notes.append(
            f"{len(found.outliers)} of {count} values are outliers, far from those of all their neighbours: method auto "
            "replaces them, the others follow them."
        )
    return replace(found, notes=tuple(notes))
