"""Spectra by curved patches and of flat tori against the exact ones."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.operators.elements_periodic import periodic_operator, periodic_surface
from surfexp.operators.fem import fem
from surfexp.populations.disguise import disguise
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp_studies.convergence.spectrum_error import spectrum_error


@pytest.mark.slow
def test_patches_gain_on_the_sphere_and_on_the_torus() -> None:
    ball = icosphere(3)
    operator = fem(ball.mesh)
    flat, patched = (
        spectrum_error(ball, surface_spectrum(ball, operator, 30, order=2, patches=patches)).metrics["error_high"]
        for patches in (False, True)
    )
    assert patched < 0.05 * flat
    ring = torus(40, 16)
    finest = torus(120, 48)
    known = surface_spectrum(finest, fem(finest.mesh), 20, order=2, curved=True).values[1:]
    errors = [
        np.abs(surface_spectrum(ring, fem(ring.mesh), 20, order=2, patches=patches).values[1:] / known - 1.0).max()
        for patches in (False, True)
    ]
    assert errors[1] < 0.2 * errors[0]


@pytest.mark.parametrize("lattice", ["square", "hexagonal"])
@pytest.mark.parametrize(("order", "bound"), [(1, 0.3), (2, 7e-3), (3, 1e-4)])
def test_flat_tori_have_their_exact_spectra(lattice: str, order: int, bound: float) -> None:
    surface = periodic_surface(16, lattice)
    operator = periodic_operator(surface)
    assert operator.areas.sum() == pytest.approx(surface.metrics["area"], rel=1e-12)
    found = spectrum_error(surface, surface_spectrum(surface, operator, 30, order=order)).metrics
    assert found["error_high"] < bound and found["below_exact"] == 0
    assert surface_spectrum(surface, operator, 30, order=order).values[1:7] == pytest.approx(
        surface.shape.spectrum(7)[1:], rel=bound
    )


def test_a_flat_torus_is_not_taken_for_its_drawing() -> None:
    surface = periodic_surface(12)
    assert surface.mesh.is_closed and surface.mesh.genus == 1
    with pytest.raises(ValueError, match="take operator=periodic"):
        spectrum_error(surface, surface_spectrum(surface, fem(surface.mesh), 30))
    with pytest.raises(ValueError, match="has no periods"):
        periodic_operator(icosphere(1))
    with pytest.raises(ValueError, match="choose square or hexagonal"):
        periodic_surface(12, "round")
    with pytest.raises(ValueError, match="choose curved=false"):
        surface_spectrum(surface, fem(surface.mesh), 5, order=2, curved=True)
    shuffled = disguise(surface, rotated=False)
    with pytest.raises(ValueError, match="take a flat_torus as it is made"):
        periodic_operator(shuffled)
