"""What geometric modes add, where it is known: twins, equal bases, and differences with their intervals."""

from dataclasses import replace

import numpy as np
import pytest

from surfexp.contract.member import Member
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.fem import fem
from surfexp.operators.shuffled_lengths import shuffled_lengths
from surfexp.spectrum.reconstruction import accuracy_curves, area_over_log
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp.statistics.statistic import Statistic
from surfexp_studies.geometric_modes.geometric_modes import mode_reconstruction, reconstruction_differences, twin_maps

BODY, BALL = ellipsoid(3, (1.0, 1.4, 3.0)), icosphere(3)
OPERATOR = fem(BODY.mesh)
OWN = surface_spectrum(BODY, OPERATOR, 40)
SPHERE = surface_spectrum(BALL, fem(BALL.mesh), 40)
SHUFFLED = [surface_spectrum(BODY, shuffled_lengths(BODY.mesh, seed), 40) for seed in (0, 1)]
SURFACE = replace(BODY, scalars={"height": BODY.mesh.vertices[:, 2] ** 3, "side": np.abs(BODY.mesh.vertices[:, 0])})
BASES = {Member("ball", "sphere"): SPHERE} | {Member(f"s{k}", "shuffled"): system for k, system in enumerate(SHUFFLED)}
FOUND = mode_reconstruction(SURFACE, OPERATOR, OWN, BASES, ["height", "side"], ["own", "sphere"], 5, 4, 40)


def test_twins_have_the_spectrum_that_they_say() -> None:
    maps = twin_maps(OWN, 30, range(2000))
    coefficients = OWN.vectors.T @ (mass_matrix(OPERATOR) @ maps)
    assert np.abs(coefficients[[0]]).max() < 1e-10 and np.abs(coefficients[30:]).max() < 1e-10
    powers = (coefficients[1:30] ** 2).mean(axis=1) * OWN.values[1:30]
    np.testing.assert_allclose(powers, 1.0, atol=0.2)
    np.testing.assert_allclose(twin_maps(OWN, 30, [7])[:, 0], maps[:, 7], atol=1e-12)


def test_areas_curves_and_differences_are_those_of_the_curves() -> None:
    mass = mass_matrix(OPERATOR)
    one = SURFACE.scalars["height"][:, None]
    curve = {"own": accuracy_curves(OWN.vectors, mass, one), "sphere": accuracy_curves(SPHERE.vectors, mass, one)}
    two = np.hstack([accuracy_curves(system.vectors, mass, one) for system in SHUFFLED])
    metrics = FOUND.metrics
    for name, values in curve.items():
        assert metrics[f"area height, {name}"] == pytest.approx(area_over_log(values, 4, 40)[0])
        assert metrics[f"end height, {name}"] == pytest.approx(values[-1, 0])
        np.testing.assert_allclose(FOUND.columns[f"height, {name}"][:, 0], values[3:, 0])
    areas = area_over_log(two, 4, 40)
    assert metrics["area height, shuffled"] == pytest.approx(areas.mean())
    differences = area_over_log(curve["own"], 4, 40) - areas
    assert metrics["own less shuffled, height"] == pytest.approx(differences.mean())
    assert metrics["own less shuffled, height, least"] == pytest.approx(differences.min())
    assert metrics["own less shuffled, height, largest"] == pytest.approx(differences.max())
    np.testing.assert_allclose(FOUND.columns["height, shuffled"][:, 1:], np.sort(two[3:], axis=1))
    assert FOUND.columns["modes"].tolist() == list(range(4, 41))


def test_the_truth_of_twins_is_seen() -> None:
    metrics = FOUND.metrics
    assert metrics["end twin of own, own"] == pytest.approx(1.0, abs=1e-12)
    assert metrics["end twin of sphere, sphere"] == pytest.approx(1.0, abs=1e-3)
    assert metrics["own less sphere, twin of own, least"] > 0.0
    assert metrics["end twin of own, sphere"] < 0.99 > metrics["end twin of sphere, own"]
    # each twin with itself: the spread of differences is not that of all pairs of twins
    curves = accuracy_curves(OWN.vectors, mass_matrix(OPERATOR), twin_maps(OWN, 40, range(5)))
    other = accuracy_curves(SPHERE.vectors, mass_matrix(OPERATOR), twin_maps(OWN, 40, range(5)))
    differences = area_over_log(curves, 4, 40) - area_over_log(other, 4, 40)
    assert metrics["own less sphere, twin of own, least"] == pytest.approx(differences.min())
    assert metrics["own less sphere, twin of own, largest"] == pytest.approx(differences.max())


def test_differences_by_map_with_their_interval() -> None:
    def made(values: list[float], other: list[float]) -> Statistic:
        names = ("a", "b", "c, d")
        metrics = {f"own less sphere, {name}": value for name, value in zip(names, values, strict=True)}
        metrics |= {f"own less sphere, {name}, least": -9.0 for name in names}
        metrics |= {f"own less odd, {name}": value for name, value in zip(names, other, strict=True)}
        return Statistic("x", metrics=metrics | {"sphere less odd, a": 5.0})

    sides = {Member("l"): made([0.1, 0.2, 0.6], [0.3] * 3), Member("r"): made([0.3, 0.4, 0.8], [0.5] * 3)}
    found = reconstruction_differences(sides, ["a", "b"])
    assert found.rows == ("sphere", "odd") and found.metrics["maps"] == 2
    assert found.metrics["own less sphere"] == pytest.approx(0.25)
    # of two maps with .2 and .3 every fourth draw is twice the smaller one
    assert found.metrics["own less sphere, low"] == pytest.approx(0.2)
    assert found.metrics["own less sphere, high"] == pytest.approx(0.3)
    np.testing.assert_allclose(found.columns["difference"][1], 0.4)
    np.testing.assert_allclose(found.columns["b"], [0.3, 0.4])
    with pytest.raises(ValueError, match="1 maps, at least 2"):
        reconstruction_differences(sides, ["a"])
    with pytest.raises(ValueError, match="has no metric 'own less sphere, z'"):
        reconstruction_differences(sides, ["a", "z"])


def test_what_does_not_fit_is_refused() -> None:
    def run(**changes: object) -> None:
        given = {"bases": BASES, "maps": ["height"], "twins": [], "seeds": 2, "first": 4, "last": 40} | changes
        mode_reconstruction(SURFACE, OPERATOR, OWN, **given)  # type: ignore[arg-type]

    with pytest.raises(ValueError, match="no map 'depth' on ellipsoid, choose of height, side"):
        run(maps=["depth"])
    with pytest.raises(ValueError, match="no basis 'torus' to make twins of, choose of own, sphere, shuffled"):
        run(twins=["torus"])
    with pytest.raises(ValueError, match="has the class 'own'"):
        run(bases={Member("x", "own"): SPHERE})
    with pytest.raises(ValueError, match="has 40 modes of 642 vertices, complete True; 41 of 642"):
        run(last=41)
    with pytest.raises(ValueError, match="complete False"):
        run(bases={Member("x", "sphere"): replace(SPHERE, complete=False)})
    with pytest.raises(ValueError, match="count = 41 modes of 40"):
        twin_maps(OWN, 41, [0])
