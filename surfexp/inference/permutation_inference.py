"""Null distributions of the statistics of a map by rearranging observations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.threads import in_threads
from surfexp.inference.cluster_enhancement import enhanced
from surfexp.inference.clusters import Clusters, clusters_beyond
from surfexp.inference.corrections import ROUNDING
from surfexp.inference.linear_model import ContrastModel
from surfexp.inference.rearrangements import Rearrangements, unchanged
from surfexp.inference.vertex_graph import VertexGraph

# rearrangements whose maps are computed by one product
BATCH = 32
Progress = Callable[[int, float], None]


@dataclass(frozen=True, eq=False)
class Statistics:
    """What is computed of each map of t.

    Parameters
    ----------
    graph : VertexGraph
    threshold : float
        |t| from which on vertices form clusters.
    extent_power, height_power : float
        Of threshold-free enhancement.
    two_sided : bool
    """

    graph: VertexGraph
    threshold: float
    extent_power: float = 1.0
    height_power: float = 2.0
    two_sided: bool = True

    def enhanced(self, t: Floats) -> Floats:
        """Return the threshold-free enhancement of a map.

        Parameters
        ----------
        t : (n,) float64

        Returns
        -------
        (n,) float64
        """
        powers = {"extent_power": self.extent_power, "height_power": self.height_power}
        return enhanced(t, self.graph, two_sided=self.two_sided, **powers)

    def clusters(self, t: Floats) -> Clusters:
        """Return the clusters of a map.

        Parameters
        ----------
        t : (n,) float64

        Returns
        -------
        Clusters
        """
        return clusters_beyond(t, self.graph, self.threshold, two_sided=self.two_sided)

    def size(self, values: Floats) -> Floats:
        """Return what is compared: the modulus, or of one-sided tests what is positive.

        Parameters
        ----------
        values : (...) float64

        Returns
        -------
        (...) float64
            0 or more.
        """
        return np.abs(values) if self.two_sided else np.maximum(values, 0.0)


@dataclass(frozen=True, eq=False)
class NullDistributions:
    """What rearrangements gave.

    Parameters
    ----------
    t, tfce : (n,) float64
        Of the data as they are.
    largest : dict of str to (r,) float64
        The largest "t", "tfce", "extent" and "mass" of each rearrangement.
    p_t, p_tfce : (n,) float64
        Uncorrected: at each vertex the share of rearrangements that reach the observed value there.
    """

    t: Floats
    tfce: Floats
    largest: dict[str, Floats]
    p_t: Floats
    p_tfce: Floats


def null_distributions(
    model: ContrastModel,
    chosen: Rearrangements,
    statistics: Statistics,
    *,
    threads: int = 1,
    progress: Progress | None = None,
) -> NullDistributions:
    """Compute all statistics for all rearrangements.

    Parameters
    ----------
    model : ContrastModel
    chosen : Rearrangements
        Which contain the unchanged one.
    statistics : Statistics
    threads : int
        The result is the same for any number.
    progress : callable, optional
        Receives the number of rearrangements done and the share that is left.

    Returns
    -------
    NullDistributions
    """
    t = model.t_maps(unchanged(len(model.direction)))[0]
    tfce = statistics.enhanced(t)
    work = partial(_of_batch, model, statistics, statistics.size(t), statistics.size(tfce))
    batches = [chosen.part(start, start + BATCH) for start in range(0, len(chosen), BATCH)]
    largest, counts, done = [], np.zeros((2, len(t)), dtype=np.int64), 0
    for part, (maxima, reached) in zip(batches, in_threads(work, batches, threads), strict=True):
        largest.append(maxima)
        counts += reached
        done += len(part)
        if progress is not None:
            progress(done, 1.0 - done / len(chosen))
    columns = np.concatenate(largest).T
    named = dict(zip(("t", "tfce", "extent", "mass"), columns, strict=True))
    return NullDistributions(t, tfce, named, counts[0] / len(chosen), counts[1] / len(chosen))


def _of_batch(
    model: ContrastModel, statistics: Statistics, t: Floats, tfce: Floats, part: Rearrangements
) -> tuple[Floats, Integers]:
    """The largest of each statistic, and at how many maps each vertex reaches what was observed."""
    maxima, reached = np.empty((len(part), 4)), np.zeros((2, len(t)), dtype=np.int64)
    for row, one in enumerate(model.t_maps(part)):
        clusters, sizes = statistics.clusters(one), statistics.size(one)
        raised = statistics.size(statistics.enhanced(one))
        groups = (sizes, raised, clusters.areas, clusters.masses)
        maxima[row] = [group.max(initial=0.0) for group in groups]
        reached[0] += sizes >= t * (1.0 - ROUNDING)
        reached[1] += raised >= tfce * (1.0 - ROUNDING)
    return maxima, reached
