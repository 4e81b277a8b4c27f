"""A method of smoothing whose parameter is chosen by the data, held against the truth where there is one."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.methods import MethodName, Methods
from surfexp.smoothing.parameter_choice import RULES, Rule, smooth_on_grid
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.variational.image import Image
from surfexp.variational.noise_level import noise_level
from surfexp.variational.solution import Solution

from .border_measures import BORDER_METRICS, border_measures, false_border_of_noise
from .planted_maps import INSIDE

SMOOTHING_METRICS = {
    "rmse": Metric("root mean square error by area", "unit of the image", "lower"),
    "rmse stein": Metric("the same with the parameter of Stein's estimate", "unit of the image", "lower"),
    "rmse discrepancy": Metric("the same with that of the discrepancy principle", "unit of the image", "lower"),
    "rmse hold_out": Metric("the same with that of the other repetition", "unit of the image", "lower"),
    "rmse oracle": Metric("the least error of the grid, in hindsight", "unit of the image", "lower"),
    "correlation": Metric("correlation by area with the truth", better="higher"),
    "parameter": Metric("chosen parameter"),
    "at_the_end": Metric("whether the chosen parameter is the first or the last of its grid"),
    "noise_estimate": Metric("estimated standard deviation of the noise", "unit of the image"),
    "largest_gap": Metric("largest relative gap of a minimisation", better="lower"),
    **BORDER_METRICS,
}


def chosen_smoothing(
    mesh: TriangleMesh,
    operator: SurfaceOperator,
    image: Image,
    method: MethodName,
    rule: Rule = "hold_out",
    eigensystem: EigenSystem | None = None,
    seed: int = 0,
) -> Solution:
    """Smooth repetitions of a map by a method, choose its parameter by a rule, and measure what came out.

    Parameters
    ----------
    mesh : TriangleMesh
    operator : SurfaceOperator
    image : Image
        Its columns are repetitions of one map.
    method, eigensystem
        As in `Methods`.
    rule : {"hold_out", "stein", "discrepancy"}
        Which one chooses what is returned; the metrics tell of all three.
    seed : int
        Of the probe of Stein's estimate.

    Returns
    -------
    Solution
        `values` are (n, r); metrics are means over the repetitions.
    """
    maps = image.values.reshape(len(image.values), -1)
    noise = float(np.mean([noise_level(operator, column) for column in maps.T]))
    methods = Methods(mesh, operator, noise, eigensystem)
    smoother, parameters = methods.smoother(method)
    grid = smooth_on_grid(smoother, maps, parameters, operator.mass, noise, seed)
    rules = [name for name in RULES if name != "hold_out" or maps.shape[1] > 1]
    chosen = {name: grid.chosen(name) for name in rules}
    place = chosen[rule if rule in chosen else "stein"]
    values = grid.values[place]
    metrics = {
        "parameter": float(grid.parameters[place]),
        "at_the_end": float(len(parameters) > 1 and place in (0, len(parameters) - 1)),
        "noise_estimate": noise,
        "largest_gap": methods.largest_gap,
    }
    if image.clean is not None:
        clean = image.clean.reshape(maps.shape)
        errors = np.array([_error(operator, smoothed, clean) for smoothed in grid.values])
        metrics |= {"rmse": float(errors[place]), "rmse oracle": float(errors.min())}
        metrics |= {f"rmse {name}": float(errors[at]) for name, at in chosen.items()}
        metrics |= _correlation(operator, values, clean) | _borders(mesh, operator, image, values, clean)
    energy = float(operator.mass @ ((values - maps) ** 2).mean(axis=1))
    return Solution(
        values if image.values.ndim == 2 else values[:, 0],
        energy,
        converged=methods.all_converged,
        reason=f"chosen by {rule}",
        model=method.replace("_", " "),
        solver="chosen smoothing",
        metrics=metrics,
    )


def _error(operator: SurfaceOperator, values: Floats, clean: Floats) -> float:
    return float(np.sqrt(operator.mass @ ((values - clean) ** 2).mean(axis=1) / operator.mass.sum()))


def _correlation(operator: SurfaceOperator, values: Floats, clean: Floats) -> dict[str, float]:
    """Mean over the repetitions; nothing where one of both is constant."""
    share = operator.mass[:, None] / operator.mass.sum()
    first, second = (part - (share * part).sum(axis=0) for part in (values, clean))
    products = [(share * a * b).sum(axis=0) for a, b in ((first, second), (first, first), (second, second))]
    if not (products[1] > 0).all() or not (products[2] > 0).all():
        return {}
    return {"correlation": float((products[0] / np.sqrt(products[1] * products[2])).mean())}


def _borders(
    mesh: TriangleMesh, operator: SurfaceOperator, image: Image, values: Floats, clean: Floats
) -> dict[str, float]:
    """Measures of the borders, means over the repetitions in which there are any."""
    if INSIDE in image.labels:
        levels = float(clean.min()), float(clean.max())
        rows = [border_measures(mesh, operator, column, image.labels[INSIDE], levels) for column in values.T]
    elif np.ptp(clean) == 0:
        level = 0.5 * image.noise
        rows = [{"false_border": false_border_of_noise(mesh, operator, column, level)} for column in values.T]
    else:
        rows = []
    names = {name for row in rows for name in row}
    return {name: float(np.mean([row[name] for row in rows if name in row])) for name in sorted(names)}
