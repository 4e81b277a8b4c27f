"""Fidelities that are a quadratic and a box at each vertex: ROF, inpainting and the convex Chan-Vese step."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats

LEAST_SPREAD = 1e-4


@dataclass(frozen=True, eq=False)
class SeparableQuadratic:
    """H(phi) = sum_i m_i [ a_i/2 (phi_i - I_i)^2 + r_i phi_i ] with lower <= phi_i <= upper.

    Parameters
    ----------
    name : str
    mass : (n,) float64
        Lumped mass.
    weight, target, slope : (n,) or (n, c) float64
        a, I and r.
    lower, upper : float
        The box; infinite where there is none.
    trivial_energy : float, optional
        Energy of the best labelling that needs no optimisation. The relative gap is the gap over the spread from there
        down to the lower bound; without it, the gap over the energy.
    """

    name: str
    mass: Floats
    weight: Floats
    target: Floats
    slope: Floats
    lower: float = -np.inf
    upper: float = np.inf
    trivial_energy: float | None = None

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Shape of the unknown."""
        return self.target.shape

    @cached_property
    def strong_convexity(self) -> float:
        """The least a_i."""
        return float(self.weight.min())

    @cached_property
    def is_quadratic(self) -> bool:
        """Whether there is no box, and so a linear system in place of a proximal map."""
        return bool(np.isinf(self.lower) and np.isinf(self.upper))

    @cached_property
    def step(self) -> float:
        """1/mu; 2 % of the box times the edge length where some a_i are 0; 0.05 / mean|r| for a linear term."""
        if self.strong_convexity > 0:
            return 1.0 / self.strong_convexity
        if self.weight.any() and self.is_quadratic:
            return float(1.0 / self.weight.mean())
        if self.weight.any():
            return float(0.02 * (self.upper - self.lower) * np.sqrt(self.mass.mean())) or 1.0
        return float(0.05 / max(np.abs(self.slope).mean(), 1e-300))

    def value(self, values: Floats) -> float:
        """H(phi)."""
        if values.min() < self.lower or values.max() > self.upper:
            return float(np.inf)
        return float(_value(self._mass, *self._data, values.ravel()))

    def prox(self, values: Floats, step: float) -> Floats:
        """clip((v + step (a I - r)) / (1 + step a))."""
        result = np.empty(self.shape)
        _prox(*self._data, self.lower, self.upper, values.ravel(), step, result.reshape(-1))
        return result

    def dual_value(self, load: Floats) -> float:
        """D(d), by the minimiser in closed form; -inf where a linear term is unbounded below."""
        minimiser = self._minimiser(load)
        if not np.isfinite(minimiser).all():
            return -float(np.inf)
        return float(_value(self._mass, *self._data, minimiser.ravel()) + np.vdot(load, minimiser))

    def primal_from_dual(self, load: Floats) -> Floats | None:
        """clip(I - (d/m + r)/a) if every a_i > 0."""
        return self._minimiser(load) if self.strong_convexity > 0 else None

    def initial(self) -> Floats:
        """The target clipped to the box, the middle of the box where nothing is known."""
        middle = 0.5 * (self.lower + self.upper) if not self.is_quadratic else 0.0
        return np.clip(np.where(self.weight > 0, self.target, middle), self.lower, self.upper)

    @cached_property
    def tolerance(self) -> float:
        """1e-4 of the energy, or 1e-2 of what the best trivial field leaves to gain."""
        return 1e-4 if self.trivial_energy is None else 1e-2

    def gap_scale(self, energy: float, lower_bound: float) -> float:
        """The spread from `trivial_energy` to the lower bound, not less than 1e-4 int |r|; without it the energy.

        The energy counts as not less than 1e-12 of that of the best constant, so that no offset of the image enters.
        """
        if self.trivial_energy is not None:
            floor = LEAST_SPREAD * float(self._mass @ np.abs(self._data[2]))
            return max(self.trivial_energy - lower_bound, floor, float(np.finfo(float).tiny))
        return float(max(energy, 1e-12 * self._energy_of_constant, np.finfo(float).tiny))

    @cached_property
    def _energy_of_constant(self) -> float:
        """H of the constant with the mean of the target by weight and mass, each channel its own."""
        shares = self.weight * self.mass.reshape(-1, *[1] * (len(self.shape) - 1))
        total = np.maximum(shares.sum(axis=0), np.finfo(float).tiny)
        means = self.target[0] + (shares * (self.target - self.target[0])).sum(axis=0) / total
        return float(_value(self._mass, *self._data, _flat(np.broadcast_to(means, self.shape))))

    def channel(self, index: int) -> SeparableQuadratic:
        """Return the fidelity of one channel of several."""
        weight, target, slope = (np.ascontiguousarray(a[:, index]) for a in (self.weight, self.target, self.slope))
        return SeparableQuadratic(self.name, self.mass, weight, target, slope, self.lower, self.upper)

    def _minimiser(self, load: Floats) -> Floats:
        result = np.empty(self.shape)
        _minimiser(self._mass, *self._data, self.lower, self.upper, load.ravel(), result.reshape(-1))
        return result

    @cached_property
    def _data(self) -> tuple[Floats, Floats, Floats]:
        return (_flat(self.weight), _flat(self.target), _flat(self.slope))

    @cached_property
    def _mass(self) -> Floats:
        return np.repeat(self.mass, self.target.size // len(self.mass))


def _flat(array: Floats) -> Floats:
    return np.ascontiguousarray(array, dtype=np.float64).ravel()


def rof(mass: Floats, image: Floats, mu: float) -> SeparableQuadratic:
    """Return mu/2 |phi - I|_m^2 of (2.6); mu-strongly convex, relative gap on the scale of the energy.

    Parameters
    ----------
    mass : (n,) float64
    image : (n,) or (n, c) float64
    mu : float
        Weight, in 1 / (unit of the image * unit of length).

    Raises
    ------
    ValueError
        If mu is not positive.
    """
    check_positive("mu", mu)
    return SeparableQuadratic("ROF", mass, np.full(image.shape, float(mu)), image, np.zeros(image.shape))


def inpainting(mass: Floats, image: Floats, known: NDArray[np.bool_], mu: float) -> SeparableQuadratic:
    """Return mu/2 |phi - I|^2 over the known vertices, (2.8), with the box [min I, max I] over them.

    Parameters
    ----------
    mass, image, mu
        As in `rof`.
    known : (n,) bool
        False in the hole D.

    Raises
    ------
    ValueError
        If mu is not positive or nothing is known.
    """
    check_positive("mu", mu)
    if not known.any():
        raise ValueError(f"0 of {len(known)} vertices are known, inpainting needs at least 1")
    weight = np.zeros(image.shape)
    weight[known] = mu
    zero = np.zeros(image.shape)
    low, high = float(image[known].min()), float(image[known].max())
    return SeparableQuadratic("inpainting", mass, weight, image, zero, low, high)


def convex_chan_vese(mass: Floats, slope: Floats, trivial_energy: float = np.inf) -> SeparableQuadratic:
    """Return int phi mu r over 0 <= phi <= 1, (2.19).

    Parameters
    ----------
    mass : (n,) float64
    slope : (n,) float64
        mu r, r = (c1 - I)^2 - (c2 - I)^2.
    trivial_energy : float
        Energy of a labelling that needs no optimisation, such as a threshold of the image; the empty and the full field,
        0 and int mu r, are always considered. The relative gap is the gap over the spread from the least of them down to
        the lower bound.
    """
    zero = np.zeros(slope.shape)
    trivial = min(0.0, float(mass @ slope), trivial_energy)
    return SeparableQuadratic("convex Chan-Vese", mass, zero, zero, slope, 0.0, 1.0, trivial)


def check_positive(name: str, value: float) -> None:
    """Raise ValueError unless 0 < value < inf."""
    if not 0 < value < np.inf:
        raise ValueError(f"{name} is {value}, must be positive and finite")


@njit(cache=True, nogil=True)
def _value(mass: Floats, weight: Floats, target: Floats, slope: Floats, values: Floats) -> float:
    total = 0.0
    for i in range(len(values)):
        difference = values[i] - target[i]
        total += mass[i] * (0.5 * weight[i] * difference * difference + slope[i] * values[i])
    return total


@njit(cache=True, nogil=True)
def _prox(
    weight: Floats, target: Floats, slope: Floats, lower: float, upper: float, values: Floats, step: float, out: Floats
) -> None:
    for i in range(len(values)):
        free = (values[i] + step * (weight[i] * target[i] - slope[i])) / (1.0 + step * weight[i])
        out[i] = min(max(free, lower), upper)


@njit(cache=True, nogil=True)
def _minimiser(
    mass: Floats, weight: Floats, target: Floats, slope: Floats, lower: float, upper: float, load: Floats, out: Floats
) -> None:
    for i in range(len(load)):
        force = load[i] / mass[i] + slope[i]
        if weight[i] > 0.0:
            out[i] = min(max(target[i] - force / weight[i], lower), upper)
        elif force == 0.0:
            out[i] = min(max(target[i], lower), upper)
        else:
            out[i] = lower if force > 0.0 else upper
