"""On which region each sulcus is measured."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp_studies.sulci import sulcal_measurement
from surfexp_studies.sulci.sulcal_lines import LINE_ESTIMATORS
from surfexp_studies.sulci.sulcal_measurement import NamedSulci, measure_sulci

BALL = icosphere(2)
N = len(BALL.mesh.vertices)


def test_each_sulcus_is_measured_on_the_vertices_that_have_its_number(monkeypatch: pytest.MonkeyPatch) -> None:
    carried, own = np.arange(N) % 5 - 1, np.arange(N)[::-1] % 7 - 1
    template = SimpleNamespace(surface=BALL, ends=[(0, 1), (2, 3)], measured=[3, 1])
    monkeypatch.setattr(sulcal_measurement, "closed_region", lambda mesh, inside: inside)
    # in place of a length: how many vertices, and the first
    monkeypatch.setattr(
        sulcal_measurement,
        "sulcal_line",
        lambda mesh, inside: SimpleNamespace(
            lengths=dict.fromkeys(LINE_ESTIMATORS, 1000.0 * inside.sum() + np.argmax(inside))
        ),
    )
    found = measure_sulci(template, BALL, NamedSulci(np.arange(N), carried, own))
    for where, regions in (("carried region", carried), ("own region", own)):
        expected = [1000.0 * (regions == number).sum() + np.flatnonzero(regions == number)[0] for number in (3, 1)]
        for name in LINE_ESTIMATORS:
            assert found[f"{where}, {name}"].tolist() == expected
