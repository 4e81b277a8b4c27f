"""A path of denoised maps as a page shows it: a slider over the weight, beside the curve of the estimated error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.tasks.denoising_path import DenoisingPath
from surfexp.tasks.risk_curve import RISK_AXIS, WEIGHT_AXIS, WORSE, RiskCurve
from surfexp.viewer.curve import Curve
from surfexp.viewer.scene import Field, Scene, Stop

SAID = "Relative gap {gap}, proved.\nEstimated mean square error {value:.3f} ± {error:.3f} of the variance of the noise"


def path_columns(path: DenoisingPath) -> Floats:
    """Return (n, k + 1) the map before, then those of the weights that were solved; four columns at least.

    Parameters
    ----------
    path : DenoisingPath
        Of one channel.
    """
    maps = [path.given, *(path.at(float(weight)).values for weight in path.weights)]
    if len(maps) == 3:  # three may be read as colours
        maps.append(maps[-1])
    return np.column_stack(maps)


def path_scene(scene: Scene, path: DenoisingPath) -> Scene:
    """Return the scene of these columns as one of the path: a slider that first stands where the estimated error is least.

    Parameters
    ----------
    scene : Scene
        Whose surfaces have the columns as steps of their first field.
    path : DenoisingPath
        Of one channel.
    """
    risk = path.risk()
    stops = _stops(path, risk)
    for drawn in scene.surfaces:
        series = drawn.fields[0]
        before, *steps = (replace(step, name="") for step in series.steps[: len(path.weights) + 1])
        drawn.fields[:] = [
            replace(series, name="denoised", steps=tuple(steps), stops=stops, start=risk.best),
            Field("before", (before,), series.scale),
        ]
    return replace(scene, curve=_curve(path, risk))


def _stops(path: DenoisingPath, risk: RiskCurve) -> tuple[Stop, ...]:
    return tuple(Stop(path.place(float(weight)), f"{WEIGHT_AXIS} {weight:.3g}") for weight in risk.weights)


def _curve(path: DenoisingPath, risk: RiskCurve) -> Curve:
    gaps = [path.at(float(weight)).certificate["relative_gap"] for weight in risk.weights]
    words = [
        SAID.format(gap=f"{gap:.1e}".replace("e-0", "e-"), value=value, error=error)
        + (": the least." if k == risk.best else ".")
        for k, (gap, value, error) in enumerate(zip(gaps, risk.risks, risk.errors, strict=True))
    ]
    highest = max(WORSE, 2.0 * float(risk.risks.min()))
    return Curve(
        risk.weights, risk.risks, risk.errors, risk.best, tuple(words), WEIGHT_AXIS, RISK_AXIS, path.weights, highest
    )
