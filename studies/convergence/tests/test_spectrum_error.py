"""Errors of spectra and their orders of convergence."""

from __future__ import annotations

from dataclasses import replace

import pytest

from surfexp.contract.member import Member
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp_studies.convergence.spectrum_error import convergence_orders, spectrum_error


def spectrum(surface: Surface, count: int = 25, **options):
    return surface_spectrum(surface, fem(surface.mesh), count, **options)


def test_orders_of_convergence_are_fitted() -> None:
    found = {}
    for name, options in (("P1", {}), ("P2", {"order": 2}), ("P2 curved", {"order": 2, "curved": True})):
        for level in (2, 3):
            surface = icosphere(level)
            found[Member(f"{name}, {level}", name, level=level)] = spectrum_error(surface, spectrum(surface, **options))
    orders = convergence_orders(found).metrics
    assert orders["order P1"] == pytest.approx(2.0, abs=0.2)
    assert orders["order P2"] == pytest.approx(2.0, abs=0.2)
    assert orders["order P2 curved"] == pytest.approx(4.0, abs=0.3)
    assert convergence_orders(found).rows == ("2", "3")
    one, two, three = list(found.values())[:3]
    with pytest.raises(ValueError, match="'P1' has no level"):
        convergence_orders({Member("P1"): one})
    with pytest.raises(ValueError, match="the same for all"):
        convergence_orders(
            {Member("a", level=2): one, Member("b", "c", level=2): two, Member("d", "c", level=3): three}
        )


@pytest.mark.parametrize("name", ["", "disk", "torus"])
def test_renaming_a_surface_changes_no_number(name: str) -> None:
    surface = icosphere(2)
    system = spectrum(surface, 40, order=2, curved=True)
    renamed = spectrum_error(replace(surface, name=name), system, 4, 8)
    assert renamed.metrics == spectrum_error(surface, system, 4, 8).metrics
