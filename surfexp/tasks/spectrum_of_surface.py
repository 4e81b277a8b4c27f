"""The spectrum of one surface, asked more than once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import TypeVar, get_args

from surfexp.contract.arrays import Floats
from surfexp.mesh.given_numbers import given_threads, one_of, real_number, whole_number
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import Boundary, Mass, SurfaceElements
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensolver_error import SliverError
from surfexp.spectrum.eigensystem import EigenSystem, clusters
from surfexp.spectrum.lowest_pairs import assembled, without_slivers
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.spectrum_range import pairs_between
from surfexp.spectrum.surface_spectrum import elements_of, surface_spectrum
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for

Answer = TypeVar("Answer")


class Spectrum:
    """Laplace-Beltrami eigenpairs of a surface, cached between calls.

    The matrices, the elimination order, the counts of eigenvalues below every shift so far and the pairs found so far are
    cached. A call for fewer pairs than before costs nothing.
    If slivers leave an answer in doubt, this and all later ones are of the intrinsic Delaunay triangles of the same surface,
    with a note.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        Only the part inside its mask counts.
    tolerance : float
        Largest relative residual.
    mass : "consistent" or "lumped"
    boundary : "neumann" or "dirichlet"
    threads : int, optional
        Of `first`, for more than 200 pairs; all cores if not given. The result has the same bytes for any number of them.

    Raises
    ------
    ValueError
        If the mesh or a parameter is unfit.

    Examples
    --------
    >>> import surfexp as sx
    >>> spectrum = sx.Spectrum(sx.shape("icosphere", levels=3))
    >>> spectrum.between(1.0, 3.0).values.round(1).tolist(), spectrum.count_below(10.0)
    ([2.0, 2.0, 2.0], 9)
    """

    def __init__(
        self,
        surface: SurfaceLike,
        *,
        tolerance: float = 1e-8,
        mass: Mass = "consistent",
        boundary: Boundary = "neumann",
        threads: int | None = None,
    ) -> None:
        self.tolerance = real_number(tolerance, "tolerance", above=0.0, below=1.0)
        one_of(mass, "mass", get_args(Mass))
        one_of(boundary, "boundary", get_args(Boundary))
        self.threads = given_threads(threads)
        self.surface = as_surface(surface)
        self.mass = mass
        self.boundary = boundary
        self.part = part_for(self.surface)
        self._operator = fem(self.part.mesh)
        self._cut = Surface(self.part.mesh, self.surface.name, self.surface.unit)
        self._square = self.part.length**2
        self._found: EigenSystem | None = None

    @cached_property
    def _elements(self) -> SurfaceElements:
        return elements_of(self._cut, assembled(self._operator), mass=self.mass, boundary=self.boundary)

    @cached_property
    def _pencil(self) -> ShiftedPencil:
        return ShiftedPencil(self._elements.stiffness, self._elements.mass)

    def _certain(self, answer: Callable[[], Answer]) -> Answer:
        try:
            return answer()
        except SliverError as stopped:
            if self._operator.name == "intrinsic_delaunay":
                raise
            self._operator = without_slivers(self._cut, stopped)
            self._found = None
            for kept in ("_elements", "_pencil"):
                self.__dict__.pop(kept, None)
        return answer()

    def first(self, count: int) -> EigenSystem:
        """Return the lowest pairs, as `surfexp.eigenpairs` does.

        Parameters
        ----------
        count : int
            How many, the zero mode of a closed surface among them.

        Returns
        -------
        EigenSystem

        Raises
        ------
        ValueError
            If the surface has fewer.
        """
        count = whole_number(count, "count", 1)
        if self._found is None or count > len(self._found.values):
            system = self._certain(
                lambda: surface_spectrum(
                    *(self._cut, assembled(self._operator), count),
                    mass=self.mass,
                    boundary=self.boundary,
                    tolerance=self.tolerance,
                    threads=self.threads,
                )
            )
            system = system.in_length(self.part.length)
            notes = self.part.notes + self._operator.notes + system.notes
            self._found = replace(system, vectors=self.part.extend(system.vectors), notes=notes)
        return _first(self._found, count)

    def between(self, low: float, high: float) -> EigenSystem:
        """Return every pair with low <= lambda <= high, proved complete by the inertia just outside of both bounds.

        An eigenvalue that meets a bound to the tolerance, relative to the bound or to the mean spacing of eigenvalues where
        that is more, counts as inside, and a note says so.

        Parameters
        ----------
        low, high : float
            In 1 / unit^2.

        Returns
        -------
        EigenSystem
            With no pair where there is none; `metrics["first_number"]` counts the eigenvalues below the first.

        Raises
        ------
        ValueError
            If the bounds are in the wrong order, hold over a quarter of the spectrum, or the proof fails.
        """
        low, high = (real_number(low, "low") * self._square, real_number(high, "high") * self._square)
        system = self._certain(lambda: pairs_between(self._pencil, low, high, self.tolerance))
        vectors = self.part.extend(self._elements.extend(system.vectors))
        notes = self.part.notes + self._operator.notes + system.notes
        found = replace(system, vectors=vectors, notes=notes, area=self._elements.area, boundary=self.boundary)
        return found.in_length(self.part.length)

    def count_below(self, value: float) -> int:
        """Return how many eigenvalues lie below a number, by one factorisation.

        Parameters
        ----------
        value : float
            In 1 / unit^2. Near an eigenvalue the count may be that of a number up to half a percent away.

        Returns
        -------
        int

        Raises
        ------
        ValueError
            If rounding leaves the count in doubt.
        """
        value = real_number(value, "value") * self._square
        return self._certain(lambda: self._pencil.counts[self._pencil.factor(value)[0]])

    def values(self, count: int) -> Floats:
        """Return the lowest eigenvalues.

        Parameters
        ----------
        count : int

        Returns
        -------
        (count,) float64
            In 1 / unit^2.

        Raises
        ------
        ValueError
            As `first`.
        """
        return self.first(count).values


def _first(system: EigenSystem, count: int) -> EigenSystem:
    if count == len(system.values):
        return system
    values, residuals = system.values[:count], system.residuals[:count]
    metrics = {"largest_residual": float(residuals.max()), "last_value": float(values[-1])}
    metrics["clusters"] = float(len(clusters(values)))
    notes = [note for note in system.notes if "cuts a cluster" not in note]
    ends = [stop for start, stop in system.clusters if start < count < stop]
    notes += [f"k = {count} cuts a cluster of nearly equal eigenvalues: k = {stop} contains all of it" for stop in ends]
    return replace(
        system,
        values=values,
        vectors=system.vectors[:, :count],
        residuals=residuals,
        clusters=clusters(values),
        metrics=system.metrics | metrics,
        notes=tuple(notes),
    )
