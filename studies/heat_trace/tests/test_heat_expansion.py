"""The heat trace tells the corrected expansion from the published one."""

from __future__ import annotations

from dataclasses import replace

import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp_studies.heat_trace.heat_expansion import heat_expansion


def spectrum(surface: Surface, count: int = 25, **options):
    return surface_spectrum(surface, fem(surface.mesh), count, **options)


@pytest.mark.slow
def test_heat_trace_tells_the_corrected_expansion_from_the_published_one() -> None:
    sphere = icosphere(3)
    closed = heat_expansion(sphere, spectrum(sphere, 120, order=2, curved=True)).metrics
    assert closed["corrected_error"] < 0.01 < closed["published_error"]
    assert closed["constant_heard"] == pytest.approx(1 / 3, abs=0.1)
    free = heat_expansion(rectangle(25, 17), spectrum(rectangle(25, 17), 300, order=3)).metrics
    assert free["corrected_error"] < 0.005 < 0.1 < free["published_error"]
    assert free["boundary_ratio"] == pytest.approx(1.0, abs=0.05) and free["constant"] == pytest.approx(0.25)


@pytest.mark.parametrize("name", ["", "disk", "torus"])
def test_renaming_a_surface_changes_no_number(name: str) -> None:
    surface = icosphere(2)
    system = spectrum(surface, 40, order=2, curved=True)
    assert heat_expansion(replace(surface, name=name), system).metrics == heat_expansion(surface, system).metrics
