"""Skeletons of a group: alignment of their lines and principal components, with the share that each explains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats

ROUNDS = 30


@dataclass(frozen=True, eq=False)
class Components:
    """Principal components of aligned lines.

    Parameters
    ----------
    variances : (r,) float64
        Decreasing; the sum over points and coordinates of the squared deviation, over members less one.
    shares : (r,) float64
        Of the total variance.
    mean : (K, 3) float64
    modes : (r, K, 3) float64
        Of unit norm.
    scores : (s, r) float64
    """

    variances: Floats
    shares: Floats
    mean: Floats
    modes: Floats
    scores: Floats

    @property
    def total_variance(self) -> float:
        """Sum of the variances, in the unit of the surface squared."""
        return float(self.variances.sum())


def rigid_fit(moving: Floats, fixed: Floats, scale: bool = False, reflection: bool = False) -> Floats:
    """The copy of `moving` (K, 3) turned and shifted, and scaled if asked, that is nearest to `fixed` in least squares."""
    centre, target = moving.mean(axis=0), fixed.mean(axis=0)
    left, sizes, right = np.linalg.svd((moving - centre).T @ (fixed - target))
    sign = np.ones(3)
    if not reflection and np.linalg.det(left @ right) < 0:
        sign[2] = -1.0
    factor = float((sizes * sign).sum() / ((moving - centre) ** 2).sum()) if scale else 1.0
    return factor * (moving - centre) @ (left * sign) @ right + target


def align(lines: Floats, scale: bool = False, reversible: bool = True, tolerance: float = 1e-9) -> Floats:
    """Generalised Procrustes alignment (Gower 1975): each line to the mean, the mean of the aligned, until nothing moves.

    Parameters
    ----------
    lines : (s, K, 3) float64
        Points in correspondence.
    scale : bool
        Whether sizes are made equal too; sizes are kept by default.
    reversible : bool
        Whether a line may be run from its other end, as the sign of an eigenfunction is arbitrary; decided once, against the
        first line.
    tolerance : float
        How far the mean may move in the last round, in mean sizes of the lines.

    Returns
    -------
    (s, K, 3) float64
        Centred on the origin.

    Raises
    ------
    ValueError
        If there are fewer than two lines or three points, or a position is not finite.
    """
    if lines.ndim != 3 or len(lines) < 2 or lines.shape[1] < 3 or not np.isfinite(lines).all():
        raise ValueError(f"lines have shape {lines.shape}; two or more lines of three or more finite points are needed")
    aligned = lines - lines.mean(axis=1, keepdims=True)
    if reversible:
        for i in range(1, len(aligned)):
            both = [rigid_fit(line, aligned[0], scale) for line in (aligned[i], aligned[i, ::-1])]
            errors = [float(((fit - aligned[0]) ** 2).sum()) for fit in both]
            aligned[i] = both[int(np.argmin(errors))]
    mean = aligned[0]
    size = float(np.linalg.norm(aligned, axis=(1, 2)).mean())
    for _ in range(ROUNDS):
        aligned = np.stack([rigid_fit(line, mean, scale) for line in aligned])
        renewed = aligned.mean(axis=0)
        if scale:
            renewed *= size / float(np.linalg.norm(renewed))
        moved = float(np.linalg.norm(renewed - mean))
        mean = renewed
        if moved <= tolerance * size:
            break
    return aligned


def principal_components(aligned: Floats) -> Components:
    """Principal components of lines (s, K, 3), at most s - 1 of them."""
    count = len(aligned)
    mean = aligned.mean(axis=0)
    left, sizes, right = np.linalg.svd((aligned - mean).reshape(count, -1), full_matrices=False)
    rank = min(count - 1, len(sizes))
    variances = sizes[:rank] ** 2 / (count - 1)
    total = variances.sum()
    shares = variances / total if total > 0 else np.zeros(rank)
    # the coordinate of largest modulus of each mode is positive
    signs = np.sign(right[np.arange(rank), np.abs(right[:rank]).argmax(axis=1)])
    modes = (right[:rank] * signs[:, None]).reshape(rank, *mean.shape)
    return Components(variances, shares, mean, modes, left[:, :rank] * sizes[:rank] * signs)


def bootstrap_shares(aligned: Floats, draws: int = 200, level: float = 0.95, seed: int = 0) -> Floats:
    """(r, 2) percentile interval of each share, members drawn with replacement; r = s - 1.

    A draw repeats members, so that shares of the first components are biased upward a little; use it to compare.
    """
    rng, count = np.random.default_rng(seed), len(aligned)
    shares = np.zeros((draws, count - 1))
    for draw in range(draws):
        chosen = rng.integers(0, count, count)
        shares[draw] = principal_components(aligned[chosen]).shares
    return np.quantile(shares, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=0).T
