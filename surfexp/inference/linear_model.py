"""The t statistic of a contrast in a general linear model, for many rearrangements of the data at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.inference.rearrangements import Rearrangements

# of the squared data: what is left of a perfect fit, so that its t is large and finite, and the same for all of them
LEAST_RESIDUAL = 1e-12
INDEPENDENT = 1e-10


@dataclass(frozen=True, eq=False)
class ContrastModel:
    """Data and design as Freedman and Lane rearrange them.

    The design splits into the span of the nuisance, in which the contrast is 0, and one direction orthogonal to it. What the
    nuisance explains is taken from the data first; the rest is rearranged, and the full model is fitted again.

    Parameters
    ----------
    direction : (s,) float64
        Unit vector; its product with the data is proportional to the contrast of the coefficients.
    nuisance : (s, q) float64
        Orthonormal.
    residuals : (s, n) float64
        Data without what the nuisance explains, at each vertex over the largest modulus.
    freedom : int
        Degrees of freedom of the full model.
    """

    direction: Floats
    nuisance: Floats
    residuals: Floats
    freedom: int

    @property
    def has_mean(self) -> bool:
        """Whether the nuisance holds the constant, so that the contrast asks for no mean and maps can be permuted."""
        mean = np.full(len(self.direction), len(self.direction) ** -0.5)
        return bool(np.linalg.norm(self.nuisance.T @ mean) > 1.0 - INDEPENDENT)

    def t_maps(self, chosen: Rearrangements) -> Floats:
        """Return the t statistic of each rearrangement at each vertex.

        Parameters
        ----------
        chosen : Rearrangements
            r of them.

        Returns
        -------
        (r, n) float64
            0 where the data is 0.
        """
        fitted = chosen.carried(self.direction) @ self.residuals
        squares = np.einsum("sn,sn->n", self.residuals, self.residuals)
        rest = squares - fitted**2
        for column in self.nuisance.T:
            rest -= (chosen.carried(column) @ self.residuals) ** 2
        np.maximum(rest, LEAST_RESIDUAL * squares, out=rest)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(squares > 0.0, fitted * np.sqrt(self.freedom / rest), 0.0)


def contrast_model(data: Floats, design: Floats, contrast: Floats) -> ContrastModel:
    """Split a design by a contrast, and take from the data what the nuisance explains.

    Parameters
    ----------
    data : (s, n) float64
        A row for each observation.
    design : (s, p) float64
    contrast : (p,) float64

    Returns
    -------
    ContrastModel

    Raises
    ------
    ValueError
        If shapes differ, the contrast cannot be estimated, or no degree of freedom is left.

    References
    ----------
    Freedman and Lane: A nonstochastic interpretation of reported significance levels (1983). Winkler, Ridgway, Webster,
    Smith, Nichols: Permutation inference for the general linear model (2014).
    """
    count = len(data)
    if design.ndim != 2 or len(design) != count or contrast.shape != design.shape[1:]:
        raise ValueError(
            f"the design has shape {design.shape} and the contrast {contrast.shape}: ({count}, p) and (p,) are needed for "
            f"{count} maps"
        )
    # nothing depends on the units of covariates
    units = np.abs(design).max(axis=0, initial=0.0)
    units[units == 0.0] = 1.0
    design, contrast = design / units, contrast / units
    weights = np.linalg.pinv(design).T @ contrast
    if not np.any(contrast) or not np.allclose(design.T @ weights, contrast, atol=1e-8 * np.abs(contrast).max()):
        raise ValueError(
            f"contrast = {(contrast * units).tolist()} cannot be estimated from this design: columns say what others say, as a "
            "covariate that is the group; leave one out"
        )
    freedom = count - int(np.linalg.matrix_rank(design))
    if freedom < 1:
        raise ValueError(
            f"{count} maps for a design of rank {count - freedom}: at least {count - freedom + 1} are needed"
        )
    without = np.linalg.svd(contrast[None])[2][1:].T
    vectors, sizes, _ = np.linalg.svd(design @ without, full_matrices=False)
    nuisance = vectors[:, sizes > INDEPENDENT * np.linalg.norm(design)]
    direction = weights / np.linalg.norm(weights)
    data = data / np.maximum(np.abs(data).max(axis=0), np.finfo(float).tiny)
    residuals = data - nuisance @ (nuisance.T @ data)
    # t does not depend on the scale; below rounding there is nothing that the nuisance leaves unexplained
    scale = np.abs(residuals).max(axis=0)
    residuals = np.divide(residuals, scale, out=np.zeros_like(residuals), where=scale > INDEPENDENT)
    return ContrastModel(direction, nuisance, residuals, freedom)
