"""Total variation and data term of a surface problem on its narrow band, weighted by a smeared delta function."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from surfexp.baselines.data_term_transfer import transported
from surfexp.baselines.narrow_band import Indices, NarrowBand
from surfexp.contract.arrays import Floats
from surfexp.variational.separable_quadratic import SeparableQuadratic

WEIGHTED_RADIUS = 3.0
FLOOR = 1e-4


@dataclass(frozen=True, eq=False)
class BandEnergy:
    """sum_k w_k |D u|_k + sum_k m_k h(u_k), the level-set form of int_M |grad u| + h(u).

    Integrals over the surface become integrals over the band with delta(d) = (1 + cos(pi d / b)) / (2 b), |d| < b. Its
    integral is 1, also as a sum over grid planes, for b is a whole number of steps (Peskin 2002); and b is at least one
    step less than the band's radius, so that no difference D that counts lacks a neighbour. Nodes farther out get the
    weight FLOOR delta(0): they follow the others. The mass m_k = (3 w_k + sum_axis w_{k - axis}) / 6 is the one for
    which sum_k w_k |D u|^2 <= 12 / step^2 sum_k m_k u_k^2.

    Parameters
    ----------
    band : NarrowBand
        Of radius two steps or more; `WEIGHTED_RADIUS` makes b two steps, the least that is accurate.

    Raises
    ------
    ValueError
        If the band is narrower.
    """

    band: NarrowBand

    def __post_init__(self) -> None:
        if self.support < self.band.step:
            steps = self.band.radius / self.band.step
            raise ValueError(f"band has radius {steps:.3g} steps, at least 2 are needed, {WEIGHTED_RADIUS:g} are good")

    @property
    def support(self) -> float:
        """b, in the unit of the surface."""
        return self.band.step * float(np.floor(self.band.radius / self.band.step - 1.0 + 1e-9))

    @cached_property
    def cells(self) -> Floats:
        """(k,) weights w of the differences, in units of area."""
        phase = np.pi * np.minimum(np.abs(self.band.distance) / self.support, 1.0)
        return self.band.step**3 / self.support * np.maximum(0.5 * (1.0 + np.cos(phase)), FLOOR)

    @cached_property
    def mass(self) -> Floats:
        """(k,) weights m of the values, in units of area."""
        before = np.where(self.band.backward >= 0, self.cells[self.band.backward], 0.0)
        return (3.0 * self.cells + before.sum(axis=1)) / 6.0

    @property
    def difference_bound(self) -> float:
        """Upper bound 12 / step^2 of the squared norm of D in these weights."""
        return 12.0 / self.band.step**2

    def fidelity(self, on_surface: SeparableQuadratic) -> SeparableQuadratic:
        """Extend the data of a fidelity off the surface."""
        return transported(on_surface, self.mass, self.band.extend)

    def total_variation(self, values: Floats) -> float:
        """Sum of w |D u|."""
        return float(_total_variation(self.band.forward, self.cells, self.band.step, values))

    def projected_load(self, values: Floats, regularisation: float, load: Floats) -> float:
        """Set `load` to the derivative of sum w sqrt(|P D u|^2 + eps^2), P = 1 - n n^T; return that sum."""
        band = self.band
        load[:] = 0.0
        return float(_projected_load(band.forward, band.normals, self.cells, band.step, regularisation, values, load))

    def dual_ascent(self, step: float, values: Floats, dual: Floats, load: Floats) -> None:
        """Set p <- P(p + step D u) with |p| <= 1, in place, and `load` to D^T w p."""
        load[:] = 0.0
        _dual_ascent(self.band.forward, self.cells, self.band.step, step, values, dual, load)


@njit(cache=True, nogil=True)
def _total_variation(forward: Indices, cells: Floats, h: float, values: Floats) -> float:
    total = 0.0
    for i in range(len(values)):
        square = 0.0
        for axis in range(3):
            j = forward[i, axis]
            if j >= 0:
                square += (values[j] - values[i]) ** 2
        total += cells[i] * np.sqrt(square) / h
    return total


@njit(cache=True, nogil=True)
def _projected_load(
    forward: Indices, normals: Floats, cells: Floats, h: float, regularisation: float, values: Floats, load: Floats
) -> float:
    total = 0.0
    for i in range(len(values)):
        a, b, c = forward[i]
        x = (values[a] - values[i]) / h if a >= 0 else 0.0
        y = (values[b] - values[i]) / h if b >= 0 else 0.0
        z = (values[c] - values[i]) / h if c >= 0 else 0.0
        nx, ny, nz = normals[i]
        along = x * nx + y * ny + z * nz
        x, y, z = x - along * nx, y - along * ny, z - along * nz
        size = np.sqrt(x * x + y * y + z * z + regularisation * regularisation)
        total += cells[i] * size
        scale = cells[i] / (h * size)
        if a >= 0:
            load[a] += scale * x
            load[i] -= scale * x
        if b >= 0:
            load[b] += scale * y
            load[i] -= scale * y
        if c >= 0:
            load[c] += scale * z
            load[i] -= scale * z
    return total


@njit(cache=True, nogil=True)
def _dual_ascent(
    forward: Indices, cells: Floats, h: float, step: float, values: Floats, dual: Floats, load: Floats
) -> None:
    for i in range(len(values)):
        square = 0.0
        for axis in range(3):
            j = forward[i, axis]
            if j >= 0:
                dual[i, axis] += step * (values[j] - values[i]) / h
            square += dual[i, axis] ** 2
        shrink = 1.0 / np.sqrt(max(square, 1.0))
        for axis in range(3):
            j = forward[i, axis]
            if j >= 0:
                dual[i, axis] *= shrink
                force = cells[i] * dual[i, axis] / h
                load[j] += force
                load[i] -= force
