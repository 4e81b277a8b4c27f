"""Embeddings of a surface by its eigenfunctions, area-normalised: global points, heat kernel, biharmonic, diffusion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.spectrum.eigensystem import EigenSystem

Weighting = Literal["global_point", "biharmonic", "heat_kernel", "diffusion"]
WEIGHTINGS = ("global_point", "biharmonic", "heat_kernel", "diffusion")
ZERO = 1e-6


@dataclass(frozen=True, eq=False)
class SpectralEmbedding:
    """A surface as a weighted set of points in the space of its first n eigenfunctions.

    Parameters
    ----------
    points : (v, n) float64
        Row x is (w(lambda_1) phi_1(x), ..., w(lambda_n) phi_n(x)) on the surface scaled to area 1.
    weights : (v,) float64
        Share of the area that each vertex has; they sum to 1 (6.8).
    values : (n,) float64
        lambda_1, ..., lambda_n of the surface scaled to area 1.
    weighting : str
    """

    points: Floats
    weights: Floats
    values: Floats
    weighting: str = "global_point"

    def __post_init__(self) -> None:
        count, n = self.points.shape
        if self.weights.shape != (count,) or self.values.shape != (n,):
            shapes = f"{self.points.shape} points, {self.weights.shape} weights, {self.values.shape} values"
            raise ValueError(
                f"embedding has {shapes}; one weight for each row and one value for each column are needed"
            )
        bad = int((~np.isfinite(self.points)).sum()) + int((~np.isfinite(self.weights)).sum())
        if bad or count == 0:
            raise ValueError(f"embedding has {bad} entries that are not finite in {count} points: repair the mesh")

    @property
    def dimension(self) -> int:
        """Number n of eigenfunctions."""
        return int(self.points.shape[1])

    def truncated(self, n: int) -> SpectralEmbedding:
        """The same with the first n eigenfunctions."""
        if not 1 <= n <= self.dimension:
            raise ValueError(f"n = {n} eigenfunctions of {self.dimension}: take 1 <= n <= {self.dimension}")
        return replace(self, points=np.ascontiguousarray(self.points[:, :n]), values=self.values[:n])

    def rotated(self, basis: Floats) -> SpectralEmbedding:
        """The same points times an orthogonal (n, n) matrix."""
        return replace(self, points=self.points @ basis)

    def sample(self, count: int, seed: int = 0) -> SpectralEmbedding:
        """At most `count` points drawn by their area, one from each of `count` strips of equal area, equally weighted.

        The strips follow the first eigenfunction, which spreads the draw over the surface.
        """
        if count >= len(self.points):
            return self
        order = np.argsort(self.points[:, 0], kind="stable")
        edges = np.cumsum(self.weights[order]) / self.weights.sum()
        positions = (np.arange(count) + np.random.default_rng(seed).uniform(size=count)) / count
        chosen = order[np.minimum(np.searchsorted(edges, positions), len(order) - 1)]
        return replace(self, points=self.points[chosen], weights=np.full(count, 1.0 / count))


def mode_weights(values: Floats, weighting: Weighting = "global_point", time: float = 0.02) -> Floats:
    """Return w(lambda): 1 / sqrt(lambda) (6.4), 1 / lambda, exp(-lambda t / 2) (3.11) or exp(-lambda t).

    Only the first of them, as published in (6.4), does not map into l2: sum phi_i^2 / lambda_i grows like (1 / 4 pi) ln n.

    Parameters
    ----------
    values : (n,) float64
        Eigenvalues of a surface of area 1, positive.
    weighting : "global_point", "biharmonic", "heat_kernel" or "diffusion"
    time : float
        t of the last two, in units of the area.
    """
    if weighting not in WEIGHTINGS:
        raise ValueError(f"weighting {weighting!r} is unknown, choose one of {', '.join(WEIGHTINGS)}")
    if not time > 0:
        raise ValueError(f"time = {time:g} of the heat kernel, take a positive one")
    exponent = {"heat_kernel": 0.5, "diffusion": 1.0}.get(weighting)
    if exponent is not None:
        return np.asarray(np.exp(-exponent * time * values))
    return np.asarray(values ** (-0.5 if weighting == "global_point" else -1.0))


def spectral_embedding(
    system: EigenSystem, vertex_areas: Floats, n: int, weighting: Weighting = "global_point", time: float = 0.02
) -> SpectralEmbedding:
    """Embed a connected surface by its first n eigenfunctions after the constant (6.4), scaled to area 1.

    Parameters
    ----------
    system : EigenSystem
        At least n + 1 pairs, the constant among them, for the mass that `vertex_areas` lumps.
    vertex_areas : (v,) float64
        Area of each vertex; their sum is the area of the surface.
    n : int
    weighting, time
        As in `mode_weights`.

    Raises
    ------
    ValueError
        If there are too few pairs, several zero eigenvalues (components), or vectors of another length.
    """
    area = float(np.sum(vertex_areas))
    count = len(system.values)
    if len(system.vectors) != len(vertex_areas) or not area > 0:
        raise ValueError(
            f"eigenfunctions have {len(system.vectors)} rows, the surface has {len(vertex_areas)} vertices"
        )
    if count < n + 1 or n < 1:
        raise ValueError(f"n = {n} eigenfunctions after the constant need {n + 1} eigenpairs, there are {count}")
    zeros = int((system.values <= ZERO * system.values[-1]).sum())
    if zeros != 1:
        reason = "take a connected surface" if zeros > 1 else "take a surface without a Dirichlet boundary"
        raise ValueError(f"{zeros} eigenvalues are zero, an embedding needs exactly 1: {reason}")
    values = system.values[1 : n + 1] * area
    points = system.vectors[:, 1 : n + 1] * (np.sqrt(area) * mode_weights(values, weighting, time))
    return SpectralEmbedding(np.ascontiguousarray(points), np.asarray(vertex_areas) / area, values, weighting)


def check_pair(source: SpectralEmbedding, target: SpectralEmbedding) -> None:
    """Refuse two embeddings of different dimension or weighting."""
    if source.dimension != target.dimension or source.weighting != target.weighting:
        first, second = (f"{e.dimension} dimensions, {e.weighting}" for e in (source, target))
        raise ValueError(f"embeddings differ: {first} against {second}; make both with the same n and weighting")
