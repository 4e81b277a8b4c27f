"""Two surfaces' modes paired by order, by correlation in space, by a functional map, and by what is true."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks
from surfexp.embedding.mode_pairs import (
    ModePairs,
    counterparts,
    mode_correlations,
    pairs_by_correlation,
    pairs_in_order,
)
from surfexp.embedding.rigid_alignment import rigid_map
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.embedding.surface_map import Pair, zoomout_map
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem

GAP, MOST_PROVED, START, BEYOND = 0.01, 12, 10, 10
METHODS = ("order, skewness", "order, largest value", "correlation", "functional map")


@dataclass(frozen=True, eq=False)
class PairedModes:
    """What is known of the modes of a pair of surfaces, the constant left out.

    Parameters
    ----------
    single : (k,) bool
        Modes that are blocks of one.
    leading : int
        Modes before the first block of several, at most 12, whose signs were searched.
    proved : bool
        Whether their signs are proved to give the least spectral distance.
    signs : ModePairs
        The leading modes in order with these signs; no partner beyond.
    methods : dict of str to ModePairs
        Those of METHODS.
    space : ModePairs
        Counterparts by the map in space, which "correlation" pairs to the last one.
    """

    single: np.ndarray
    leading: int
    proved: bool
    signs: ModePairs
    methods: dict[str, ModePairs]
    space: ModePairs


def pair_modes(source: tuple[Surface, EigenSystem], target: tuple[Surface, EigenSystem], count: int) -> PairedModes:
    """Pair the first modes of two surfaces by each method.

    Parameters
    ----------
    source, target : tuple of Surface and EigenSystem
        With ten pairs more than `count` and the constant.
    count : int
        Modes after the constant.

    Raises
    ------
    ValueError
        If there are fewer pairs, or a spectrum is not proved complete.
    """
    for surface, system in (source, target):
        if len(system.values) < count + 1 + BEYOND or not system.complete:
            raise ValueError(
                f"{surface.name} has {len(system.values)} eigenpairs, complete {system.complete}; "
                f"{count + 1 + BEYOND} are needed, proved complete"
            )
    pair = Pair(source[0], target[0], source[1], target[1])
    first, second = (system.vectors[:, 1 : count + 1] for _, system in (source, target))
    spectra = (
        system.values[1 : count + 2] * float(areas.sum())
        for (_, system), areas in zip((source, target), pair.areas, strict=True)
    )
    blocks = eigenvalue_blocks(*spectra, gap=GAP)
    single = np.zeros(count, dtype=bool)
    single[[start for start, stop in blocks if stop == start + 1 and start < count]] = True
    leading = int(min(np.flatnonzero(~single).min(initial=count), MOST_PROVED))
    by_map = zoomout_map(pair, START, count + 1 + BEYOND, samples=800).correspondence
    in_space = rigid_map(pair.source_surface.mesh.vertices, pair.target_surface.mesh.vertices, *pair.areas)[0]
    correlations = [mode_correlations(first, second, pair.areas[1], rows) for rows in (in_space, by_map)]
    methods = {
        "order, skewness": pairs_in_order(first, second, *pair.areas, "skewness"),
        "order, largest value": pairs_in_order(first, second, *pair.areas, "largest"),
        "correlation": pairs_by_correlation(correlations[0]),
        "functional map": counterparts(correlations[1]),
    }
    proved, signs = _proved_signs(pair, leading, count)
    return PairedModes(single, leading, proved, signs, methods, counterparts(correlations[0]))


def _proved_signs(pair: Pair, leading: int, count: int) -> tuple[bool, ModePairs]:
    partners, signs = np.full(count, -1, np.int64), np.zeros(count, np.int8)
    if not leading:
        return False, ModePairs(partners, signs)
    one, other = (
        spectral_embedding(system, areas, leading, "biharmonic")
        for system, areas in zip((pair.source, pair.target), pair.areas, strict=True)
    )
    found = spectral_distance(one, other, samples=500)
    partners[:leading] = np.arange(leading)
    signs[:leading] = np.diag(found.basis).astype(np.int8)
    return found.optimal, ModePairs(partners, signs)


def true_pairs(
    source: tuple[Surface, EigenSystem], target: tuple[Surface, EigenSystem], origin: Integers, count: int
) -> ModePairs:
    """Return the counterparts by the true vertex correspondence: source vertex of each target vertex."""
    first, second = (system.vectors[:, 1 : count + 1] for _, system in (source, target))
    return counterparts(mode_correlations(first, second, target[0].mesh.vertex_areas, origin))
