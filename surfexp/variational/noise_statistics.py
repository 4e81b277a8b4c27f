"""What the values near a vertex say about the noise: local level, growth over rings, distance to the nearest values."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import csr_array, eye_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.noise_level import NORMAL_MEDIAN, affine_relations
from surfexp.variational.short_heat_flow import ShortHeatFlow

NEAREST = 3
# levels; what is 3 standard deviations from its neighbourhood has three neighbours nearer than this
FAR = 3.0
FARTHER = 5.0
SAMPLE = 20_000
RINGS = 4
# full width, in edges, over which logarithms of local levels are averaged
LEVEL_WIDTH = 4.0
HEAT_STEPS = 4
# where less of a weight arrives, far from all pairs that are used, rounding counts: factorised steps keep it positive
SMALL_WEIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class NoiseStatistics:
    """Statistics of maps on one surface, none of which a function that is affine near a vertex enters.

    Parameters
    ----------
    operator : SurfaceOperator
        Consistent.
    """

    operator: SurfaceOperator

    @cached_property
    def ring(self) -> csr_array:
        """(n, n) neighbours at an edge, entries 1."""
        ends = self.operator.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        both = np.concatenate([ends, ends[:, ::-1]])
        count = self.operator.vertex_count
        ring = csr_array((np.ones(len(both)), both.T), shape=(count, count))
        ring.data[:] = 1.0
        return ring

    @cached_property
    def relations(self) -> tuple[Integers, Floats]:
        """Corners and affine relations of the pairs of triangles."""
        return affine_relations(self.operator)

    @cached_property
    def _pairs_at(self) -> tuple[Integers, Integers]:
        """Pairs of triangles of which a vertex is a corner: where those of each vertex start, and the pairs."""
        corners = self.relations[0].ravel()
        order = np.argsort(corners, kind="stable")
        starts = np.concatenate([[0], np.cumsum(np.bincount(corners, minlength=self.operator.vertex_count))])
        return starts.astype(np.int64), (order // 4).astype(np.int64)

    @cached_property
    def _rings(self) -> tuple[Integers, list[csr_array]]:
        """A sample of vertices, and the vertices that are exactly 1, 2, 3 and 4 edges from each, entries 1."""
        count = self.operator.vertex_count
        sample = np.arange(count)
        if count > SAMPLE:
            sample = np.sort(np.random.default_rng(0).choice(count, SAMPLE, replace=False))
        inner = csr_array(eye_array(count).tocsr()[sample])
        rings = []
        for _ in range(RINGS):
            outer = csr_array(inner + inner @ self.ring)
            outer.data[:] = 1.0
            rings.append(csr_array(outer - inner))
            rings[-1].eliminate_zeros()
            inner = outer
        return sample, rings

    @cached_property
    def _flows(self) -> dict[float, ShortHeatFlow]:
        return {}

    def _flow(self, width: float) -> ShortHeatFlow:
        """Heat flow of a full width in edges, prepared once."""
        if width not in self._flows:
            time = (width * self.operator.edge_length) ** 2 / (16.0 * float(np.log(2.0)))
            self._flows[width] = ShortHeatFlow(self.operator, time, HEAT_STEPS)
        return self._flows[width]

    def deviations(self, values: Floats) -> Floats:
        """Return (e,) sizes of what is not affine on each pair of triangles; white noise gives them its own deviation."""
        corners, relations = self.relations
        return np.abs(np.einsum("ek,ek->e", relations, values[corners]))

    def local_level(self, deviations: Floats, used: np.ndarray) -> Floats:
        """Return the (n,) deviation of the noise near each vertex, by the median over the pairs of its neighbourhood.

        Logarithms are averaged over four edges. Where no pair is used, the level is that of the nearest ones.

        Parameters
        ----------
        deviations : (e,) float64
        used : (e,) bool
        """
        starts, pairs = self._pairs_at
        ring = self.ring
        medians = _local_medians(ring.indptr, ring.indices, starts, pairs, deviations, used) / NORMAL_MEDIAN
        known = medians > 0
        logs = np.log(np.where(known, medians, 1.0))
        weights = np.where(known, self.operator.mass, 0.0)
        fields = np.column_stack([weights * logs, weights]) / self.operator.mass[:, None]
        averaged = self._flow(LEVEL_WIDTH)(fields)
        if averaged[:, 1].min() < SMALL_WEIGHT:
            averaged = self._flow(LEVEL_WIDTH).by_steps(fields)
        return np.exp(averaged[:, 0] / np.maximum(averaged[:, 1], np.finfo(float).tiny))

    def smooth_noise(self, white: Floats, width: float) -> Floats:
        """Return (n, c) noise after heat flow of a full width in edges, of deviation 1 in the mean over the vertices."""
        if width == 0:
            return white
        white = self._flow(width)(white)
        return white / np.sqrt((white**2).mean(axis=0))

    def informative(self, used: np.ndarray) -> NDArray[np.bool_]:
        """Return (n,) which vertices are corners of as many pairs that are used as of others: all where all are used.

        Parameters
        ----------
        used : (e,) bool
        """
        corners = self.relations[0].ravel()
        count = self.operator.vertex_count
        return 2.0 * np.bincount(corners, np.repeat(used, 4), count) >= np.bincount(corners, minlength=count)

    def ring_medians(self, values: Floats, at: NDArray[np.bool_] | None = None) -> Floats:
        """Return (5,) levels by what is not affine on pairs of triangles, and by the distances to the means of rings 1 to 4.

        Medians over the median of a normal variable: for white noise all are its deviation.

        Parameters
        ----------
        values : (n,) float64
        at : (n,) bool, optional
            Vertices that count; all if not given.
        """
        sample, rings = self._rings
        at = np.ones(len(values), dtype=bool) if at is None else at
        pairs = at[self.relations[0]].all(axis=1)
        found = [np.median(self.deviations(values)[pairs]) if pairs.any() else 0.0]
        for ring in rings:
            counts = np.asarray(ring.sum(axis=1)).ravel()
            full = (counts > 0) & at[sample]
            distances = values[sample][full] - (ring @ values)[full] / counts[full]
            found.append(np.median(np.abs(distances) / np.sqrt(1.0 + 1.0 / counts[full])) if full.any() else 0.0)
        return np.array(found) / NORMAL_MEDIAN

    def nearest_values(self, values: Floats) -> Floats:
        """Return (n,) the mean distance of a value to the three that are nearest to it within two rings.

        At an edge of the map a vertex has neighbours on its own side; an outlier has none that is near.
        """
        ring = self.ring
        return _nearest_values(ring.indptr, ring.indices, values, NEAREST)

    def outliers(self, values: Floats, levels: Floats) -> Integers:
        """Return the vertices whose value is far from all others near them.

        The three nearest ones within two rings are three levels away in the mean, and five times as far as at their
        neighbours: where a map is steep, all are far.

        Parameters
        ----------
        values : (n,) float64
        levels : (n,) float64
            Deviation of the noise at each vertex.
        """
        distances = self.nearest_values(values)
        usual = _medians_of_neighbours(self.ring.indptr, self.ring.indices, distances)
        return np.flatnonzero((distances > FAR * levels) & (distances > FARTHER * usual))


@njit(cache=True, nogil=True)
def _local_medians(
    indptr: Integers, indices: Integers, starts: Integers, pairs: Integers, deviations: Floats, used: np.ndarray
) -> Floats:
    """Median over the pairs at each vertex and at its neighbours; 0 where there is none."""
    count = len(indptr) - 1
    result = np.zeros(count)
    most = 0
    for vertex in range(count):
        size = starts[vertex + 1] - starts[vertex]
        for place in range(indptr[vertex], indptr[vertex + 1]):
            size += starts[indices[place] + 1] - starts[indices[place]]
        most = max(most, size)
    buffer = np.empty(most)
    for vertex in range(count):
        size = 0
        for place in range(indptr[vertex] - 1, indptr[vertex + 1]):
            near = vertex if place < indptr[vertex] else indices[place]
            for pair in pairs[starts[near] : starts[near + 1]]:
                if used[pair]:
                    buffer[size] = deviations[pair]
                    size += 1
        if size:
            result[vertex] = np.median(buffer[:size])
    return result


@njit(cache=True, nogil=True)
def _nearest_values(indptr: Integers, indices: Integers, values: Floats, nearest: int) -> Floats:
    count = len(indptr) - 1
    result = np.zeros(count)
    seen = np.full(count, -1)
    best = np.empty(nearest)
    for vertex in range(count):
        seen[vertex] = vertex
        best[:] = np.inf
        found = 0
        for outer in range(indptr[vertex], indptr[vertex + 1]):
            middle = indices[outer]
            for inner in range(indptr[middle] - 1, indptr[middle + 1]):
                near = middle if inner < indptr[middle] else indices[inner]
                if seen[near] == vertex:
                    continue
                seen[near] = vertex
                found += 1
                distance = abs(values[near] - values[vertex])
                for place in range(nearest):
                    if distance < best[place]:
                        best[place], distance = distance, best[place]
        kept = min(found, nearest)
        if kept:
            result[vertex] = best[:kept].mean()
    return result


@njit(cache=True, nogil=True)
def _medians_of_neighbours(indptr: Integers, indices: Integers, values: Floats) -> Floats:
    count = len(indptr) - 1
    result = np.zeros(count)
    for vertex in range(count):
        if indptr[vertex + 1] > indptr[vertex]:
            result[vertex] = np.median(values[indices[indptr[vertex] : indptr[vertex + 1]]])
    return result
