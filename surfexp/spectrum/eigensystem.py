"""The first eigenpairs of a surface, with the proof that none is missing."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.drawable import Drawable
from surfexp.contract.metric import Metric
from surfexp.contract.summary import Summary
from surfexp.contract.threads import in_threads
from surfexp.linalg.block_products import gram, multiply_lanes, residual_norms
from surfexp.linalg.lanes import LANES

SMALLEST_GAP = 1e-6
COLUMNS_AT_ONCE = 64


@dataclass(frozen=True, eq=False, repr=False)
class EigenSystem(Drawable):
    """The k lowest pairs of A x = lambda B x.

    Parameters
    ----------
    values : (k,) float64
        Increasing, counted from 0; in 1 / length^2.
    vectors : (n, k) float64
        B-orthonormal columns; the entry of largest modulus of each is positive (the first of them, to rounding).
    residuals : (k,) float64
        |A x - lambda B x| / (max(|lambda|, spacing) |B x|).
    orthogonality : float
        Largest entry of |X^T B X - I|, X with the pairs beyond k that a cluster needed (see `notes`).
    complete : bool
        Whether it is proved that these are the k lowest: the inertia of A - s B at a shift s just above them equals the
        number of pairs found below s.
    inertia : tuple of (float, int)
        The shifts that were factorised and how many eigenvalues lie below each: the proof.
    clusters : tuple of (int, int)
        Ranges start..stop-1 of nearly equal values (relative gap under 1e-6), in which single vectors are arbitrary.
    method : str
    spacing : float
        Mean distance of eigenvalues, the scale of residuals near 0: s / N(s) at the last certified shift s with N(s)
        eigenvalues below it, and lambda_{k-1} / k where none was certified. Positive also for k = 1.
    area : float
        Area of the surface by the quadrature of its elements, 0 where the pencil belongs to no surface.
    order : int
        Order of the elements; the first rows of `vectors` are the vertices of the mesh.
    boundary : str
        "neumann" (also where there is no boundary) or "dirichlet".
    metrics : dict of str to float
    notes : tuple of str
        As in `Surface`.
    """

    values: Floats
    vectors: Floats
    residuals: Floats
    orthogonality: float
    complete: bool
    inertia: tuple[tuple[float, int], ...] = ()
    clusters: tuple[tuple[int, int], ...] = ()
    method: str = ""
    spacing: float = 0.0
    area: float = 0.0
    order: int = 1
    boundary: str = "neumann"
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "degrees_of_freedom": Metric("unknowns of the discrete problem"),
        "edge_length": Metric("mean length of the edges", "unit of length"),
        "largest_residual": Metric("largest relative residual of the pairs", better="lower"),
        "orthogonality": Metric("largest entry of V^T M V - I", better="lower"),
        "complete": Metric(
            "1 where it is proved that no eigenvalue below the last is missing, else 0", better="higher"
        ),
        "zero_modes": Metric("eigenvalues that are 0 up to rounding"),
        "first_value": Metric("first eigenvalue above the constant mode"),
        "last_value": Metric("last eigenvalue"),
        "clusters": Metric("groups of nearly equal eigenvalues"),
        "area": Metric("area", "unit of length squared"),
    }

    def in_length(self, length: float) -> EigenSystem:
        """Return the same pairs in another unit of length.

        Parameters
        ----------
        length : float
            How many of the other unit are one of the present unit.

        Returns
        -------
        EigenSystem
        """
        if length == 1.0:
            return self
        powers = {"edge_length": 1, "area": 2, "first_value": -2, "last_value": -2}
        return replace(
            self,
            values=self.values / length**2,
            vectors=self.vectors / length,
            inertia=tuple((shift / length**2, below) for shift, below in self.inertia),
            spacing=self.spacing / length**2,
            area=self.area * length**2,
            metrics={name: number * length ** powers.get(name, 0) for name, number in self.metrics.items()},
        )

    def _summary(self) -> Summary:
        found = len(self.values) > 0  # not in a window between two eigenvalues
        facts = {
            "lowest": float(self.values[0]) if found else None,
            "highest": float(self.values[-1]) if found else None,
            "complete": self.complete,
            "largest residual": float(self.residuals.max()) if found else None,
            "orthogonality": self.orthogonality,
            "clusters": len(self.clusters),
            "method": self.method,
        }
        return Summary(f"{len(self.values)} eigenpairs", facts, self.notes)


@dataclass(frozen=True, eq=False)
class Measurement:
    """What a set of vectors is worth; rows in any order.

    Parameters
    ----------
    values : (k,) float64
        Rayleigh quotients x^T A x / x^T B x.
    errors : (k,) float64
        |A x - lambda B x| / |B x| (2-norms).
    overlaps : (k,) float64
        Largest entry of |X^T B X - I| that a vector takes part in, those with vectors far before it left to these.
    spacing : float
        Mean distance of eigenvalues.
    """

    values: Floats
    errors: Floats
    overlaps: Floats
    spacing: float

    @property
    def residuals(self) -> Floats:
        """Errors over the values, or over the spacing where that is larger."""
        return self.errors / np.maximum(np.abs(self.values), self.spacing)

    @property
    def orthogonality(self) -> float:
        """Largest entry of |X^T B X - I|."""
        return float(self.overlaps.max())

    def of(self, chosen: Integers) -> Measurement:
        """Return the part of some vectors; their overlaps with the others are still in it."""
        return Measurement(self.values[chosen], self.errors[chosen], self.overlaps[chosen], self.spacing)

    def followed_by(self, before: Measurement) -> Measurement:
        """Return this measurement of the first vectors, that of the rest being the one from before."""
        rest = len(self.values)
        return Measurement(
            np.concatenate([self.values, before.values[rest:]]),
            np.concatenate([self.errors, before.errors[rest:]]),
            np.concatenate([self.overlaps, before.overlaps[rest:]]),
            before.spacing,
        )


def measure(
    stiffness: csr_array,
    mass: csr_array,
    vectors: Floats,
    count: int | None = None,
    spacing: float = 0.0,
    threads: int = 1,
) -> Measurement:
    """Measure B-normalised vectors, or the first `count` of them, some columns at a time in each thread.

    Without a spacing it is that of the Rayleigh quotients.
    """
    count = vectors.shape[1] if count is None else count
    values, errors, overlaps = np.empty((3, count))

    def measure_some(start: int) -> None:
        stop = min(start + COLUMNS_AT_ONCE, count)
        block, mass_block, error = (np.zeros((len(vectors), LANES)) for _ in range(3))
        masses = np.empty((len(vectors), stop - start), order="F")
        for first in range(start, stop, LANES):
            some = slice(first, min(first + LANES, stop))
            width = some.stop - first
            block[:, :width] = vectors[:, some]
            multiply_lanes(mass, block, mass_block)
            multiply_lanes(stiffness, block, error)
            energies, squared_norms = gram(block, error).diagonal(), gram(block, mass_block).diagonal()
            values[some] = energies[:width] / squared_norms[:width]
            quotients = np.zeros(LANES)
            quotients[:width] = values[some]
            sizes = residual_norms(error, mass_block, quotients)
            errors[some] = sizes[0][:width] / sizes[1][:width]
            masses[:, first - start : first - start + width] = mass_block[:, :width]
        products = masses.T @ vectors[:, start:]
        products[np.arange(stop - start), np.arange(stop - start)] -= 1.0
        overlaps[start:stop] = np.abs(products).max(axis=1)

    for _ in in_threads(measure_some, range(0, count, COLUMNS_AT_ONCE), threads):
        pass
    return Measurement(values, errors, overlaps, spacing or mean_spacing(values))


def mean_spacing(values: Floats) -> float:
    """Return the largest value over their number, the scale that stands in for lambda near 0."""
    return float(np.abs(values).max()) / len(values) or 1.0


def clusters(values: Floats, gap: float = SMALLEST_GAP) -> tuple[tuple[int, int], ...]:
    """Return the ranges (start, stop) of at least two values whose neighbours differ by less than `gap`, relatively."""
    close = np.diff(values) <= gap * np.maximum(np.abs(values[1:]), mean_spacing(values))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], close.astype(np.int8), [0]])))
    return tuple((int(start), int(stop) + 1) for start, stop in edges.reshape(-1, 2))


def fix_signs(vectors: Floats) -> Floats:
    """Flip columns, in place, so that the first entry within 1e-6 of the largest modulus is positive."""
    for column in vectors.T:
        sizes = np.abs(column)
        if column[np.argmax(sizes >= (1.0 - 1e-6) * sizes.max())] < 0:
            column *= -1.0
    return vectors


def measured(
    measurement: Measurement,
    vectors: Floats,
    method: str,
    inertia: tuple[tuple[float, int], ...] = (),
    complete: bool = False,
    metrics: dict[str, float] | None = None,
    notes: tuple[str, ...] = (),
) -> EigenSystem:
    """Sort measured vectors by value, fix their signs (in place), mark the clusters, and wrap all up."""
    values, residuals = measurement.values, measurement.residuals
    order = np.argsort(values, kind="stable")
    if (np.diff(order) != 1).any():
        values, residuals, vectors = values[order], residuals[order], np.asfortranarray(vectors[:, order])
    return EigenSystem(
        values=values,
        vectors=fix_signs(vectors),
        residuals=residuals,
        orthogonality=measurement.orthogonality,
        complete=complete,
        inertia=inertia,
        clusters=clusters(values),
        method=method,
        spacing=measurement.spacing,
        metrics=metrics or {},
        notes=notes,
    )
