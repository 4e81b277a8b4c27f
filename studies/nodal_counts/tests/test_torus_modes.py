"""Separated eigenfunctions of the torus: against elements, Weyl's law, Courant's bound and a thin tube."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.torus import torus
from surfexp.operators.fem import fem
from surfexp.spectrum.nodal_signature import counted_domains
from surfexp.spectrum.surface_spectrum import graph_of, surface_spectrum
from surfexp_studies.nodal_counts.torus_modes import torus_modes


def test_values_and_first_counts_are_those_of_curved_elements() -> None:
    surface = torus(60, 24)
    operator = fem(surface.mesh)
    system = surface_spectrum(surface, operator, 30, order=2, curved=True)
    values, counts = torus_modes(30)
    assert system.values[1:] == pytest.approx(values[1:], rel=2e-3)
    alone = [0, 1, 2, 3, 4, 5, 6, 7, 8]  # before the first modes that turn about the axis and the tube at once
    filtered = counted_domains(system, graph_of(operator, system), "filtered")
    assert filtered[alone].tolist() == counts[alone].tolist() == [1, 2, 2, 4, 4, 2, 2, 6, 6]


def test_weyl_and_courant() -> None:
    values, counts = torus_modes(3000)
    numbers = np.arange(1.0, 3001.0)
    assert (np.diff(values) >= 0.0).all() and values[0] == pytest.approx(0.0, abs=1e-9) and counts[0] == 1.0
    assert (counts <= numbers).all()
    area = 4.0 * np.pi**2 * 0.4
    assert (4.0 * np.pi * numbers[1000:] / (area * values[1000:])) == pytest.approx(1.0, abs=0.02)


def test_first_modes_do_not_depend_on_how_many_are_asked_for() -> None:
    few, many = torus_modes(40, 2.0, 0.5), torus_modes(900, 2.0, 0.5)
    assert few[0] == pytest.approx(many[0][:40], abs=1e-9)
    assert (few[1] == many[1][:40]).all()


def test_thin_tube_is_a_flat_torus() -> None:
    values, _ = torus_modes(25, 1.0, 0.01)
    # only turns about the axis lie below the first wave around the tube
    assert values == pytest.approx(np.sort(np.repeat(np.arange(13) ** 2, 2)[1:]), rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("bad", [(0, 1.0, 0.4), (5, 1.0, 1.0), (5, 1.0, 0.0)])
def test_unfit_input_is_refused(bad: tuple[int, float, float]) -> None:
    with pytest.raises(ValueError, match=r"count >= 1 and 0 < r < R are needed"):
        torus_modes(*bad)
