"""The trial of the automatic choice is that of the library."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.smoothing.automatic import CANDIDATES, automatic_smoothing
from surfexp.variational.image import Image
from surfexp_studies.smoothing.automatic_trial import automatic_trial

BALL = icosphere(3).mesh
OPERATOR = fem(BALL)
X = BALL.vertices[:, 0]


def test_the_trial_is_that_of_the_automatic_choice() -> None:
    truth = 3.0 * (X > 0)
    rough = truth + np.random.default_rng(2).standard_normal(len(X))
    trial = automatic_trial(BALL, OPERATOR, Image(np.column_stack([rough, -rough]), clean=np.column_stack([truth] * 2)))
    found = automatic_smoothing(BALL, OPERATOR, rough)
    error = np.sqrt(OPERATOR.mass @ (found.values - truth) ** 2 / OPERATOR.mass.sum())
    assert trial.metrics["rmse"] == pytest.approx(error)
    assert [trial.metrics[f"chosen {name}"] for name in CANDIDATES] == [
        float(name == found.method) for name in CANDIDATES
    ]
    least = min(trial.metrics[f"rmse {name}"] for name in CANDIDATES)
    assert trial.metrics["regret"] == pytest.approx(error / least) and trial.metrics["regret"] >= 1.0
    with pytest.raises(ValueError, match="no truth"):
        automatic_trial(BALL, OPERATOR, Image(rough))
