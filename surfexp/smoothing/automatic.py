"""Which method and how strongly, by Stein's estimate of the risk, from one map alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.edge_weights import ROUNDING
from surfexp.smoothing.methods import MethodName, Methods
from surfexp.smoothing.parameter_choice import smooth_on_grid
from surfexp.variational.noise_level import noise_level

# the grids of widths are those of cortices with edges of so many mm; another surface is scaled to it
EDGE_OF_GRIDS = 2.7
WIDE = ("heat_polynomial", "heat_flow", "geodesic_gaussian")
CANDIDATES: tuple[MethodName, ...] = ("heat_polynomial", "total_variation", "edge_weighted_variation")


@dataclass(frozen=True, eq=False)
class AutomaticSmoothing:
    """A map after the method and the parameter that promise the least error.

    Parameters
    ----------
    values : (n,) float64
    method : str
    parameter : float
        Full width at half maximum in the unit of the surface, or weight without unit: see `Methods.smoother`.
    noise : float
        Standard deviation that was taken for the noise.
    risk : dict of str to float
        Estimated mean square error over the variance of the noise, by method; its chance is sqrt(2 / n), so that it may be
        negative, but that is nearly the same chance for all methods.
    at_the_end : bool
        Whether the parameter is the first or the last of its grid: the best may lie beyond it.
    largest_gap : float
        Of the minimisations, relative.
    converged : bool
    """

    values: Floats
    method: MethodName
    parameter: float
    noise: float
    risk: dict[str, float]
    at_the_end: bool
    largest_gap: float
    converged: bool


def automatic_smoothing(
    mesh: TriangleMesh,
    operator: SurfaceOperator,
    values: Floats,
    noise: float | None = None,
    candidates: Sequence[MethodName] = CANDIDATES,
    seed: int = 0,
) -> AutomaticSmoothing:
    """Smooth a map by that of several methods, each on its grid of parameters, whose estimated risk is least.

    Stein's estimate takes the noise as independent and of one deviation at all vertices.

    Parameters
    ----------
    mesh : TriangleMesh
    operator : SurfaceOperator
        Of its triangles, consistent.
    values : (n,) float64
    noise : float, optional
        Standard deviation; estimated if not given.
    candidates : sequence of str
        Methods of `Methods` that need no eigensystem.
    seed : int
        Of the probe of Stein's estimate.

    Raises
    ------
    ValueError
        If there is no candidate, or the noise is not positive.

    References
    ----------
    Stein: Estimation of the mean of a multivariate normal distribution (1981).
    """
    if not candidates:
        raise ValueError(f"there are 0 candidates, at least 1 is needed: {', '.join(CANDIDATES)}")
    level = noise_level(operator, values) if noise is None else float(noise)
    scale = EDGE_OF_GRIDS / operator.edge_length
    scaled = TriangleMesh(scale * mesh.vertices, mesh.faces)
    operator = fem(scaled)
    trials = {}
    flat = np.ptp(values) <= ROUNDING * np.abs(values).max(initial=0.0)
    # a map without edges has no weights
    for name in [name for name in candidates if not (flat and name == "edge_weighted_variation")]:
        methods = Methods(scaled, operator, level)
        smoother, parameters = methods.smoother(name)
        trials[name] = methods, smooth_on_grid(smoother, values[:, None], parameters, operator.mass, level, seed)
    best = min(trials, key=lambda name: float(trials[name][1].stein.min()))
    methods, grid = trials[best]
    place = grid.chosen("stein")
    return AutomaticSmoothing(
        grid.values[place][:, 0],
        best,
        float(grid.parameters[place]) / (scale if best in WIDE else 1.0),
        level,
        {name: float(found.stein.min()) / level**2 for name, (_, found) in trials.items()},
        len(grid.parameters) > 1 and place in (0, len(grid.parameters) - 1),
        methods.largest_gap,
        methods.all_converged,
    )
