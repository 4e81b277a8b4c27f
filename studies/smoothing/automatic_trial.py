"""The automatic choice of a method against each of its candidates, held against the truth."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.automatic import CANDIDATES, automatic_smoothing
from surfexp.statistics.statistic import Statistic
from surfexp.variational.image import Image


def automatic_trial(mesh: TriangleMesh, operator: SurfaceOperator, image: Image, seed: int = 0) -> Statistic:
    """Smooth the first repetition of a map by each candidate with Stein's parameter, and take the least estimated risk.

    Parameters
    ----------
    mesh : TriangleMesh
    operator : SurfaceOperator
    image : Image
        With the truth; its first column is smoothed, the others are not looked at.
    seed : int
        Of the probe of Stein's estimate.

    Returns
    -------
    Statistic
        Rows: the candidates. Columns: parameter, risk (estimated mean square error over the variance of the noise), rmse (by
        area, against the truth), at_the_end. Metrics: `rmse` of the one with the least risk, `rmse METHOD`, `chosen METHOD` (1
        for that one, else 0), and `regret`, its rmse over the least one.

    Raises
    ------
    ValueError
        If the image has no truth.
    """
    if image.clean is None:
        raise ValueError(f"image {image.name!r} has no truth to hold the result against")
    observed, truth = (values.reshape(len(values), -1)[:, 0] for values in (image.values, image.clean))
    each = [automatic_smoothing(mesh, operator, observed, candidates=(name,), seed=seed) for name in CANDIDATES]
    share = operator.mass / operator.mass.sum()
    errors = np.array([np.sqrt(share @ (found.values - truth) ** 2) for found in each])
    risks = np.array([found.risk[found.method] for found in each])
    best = int(np.argmin(risks))
    columns = {
        "parameter": np.array([found.parameter for found in each]),
        "risk": risks,
        "rmse": errors,
        "at_the_end": np.array([float(found.at_the_end) for found in each]),
    }
    metrics = {"rmse": float(errors[best]), "regret": float(errors[best] / errors.min())}
    metrics |= {f"rmse {name}": float(error) for name, error in zip(CANDIDATES, errors, strict=True)}
    metrics |= {f"chosen {name}": float(place == best) for place, name in enumerate(CANDIDATES)}
    return Statistic("automatic choice", columns, tuple(CANDIDATES), metrics)
