"""Integrals over the band are those over the surface; loads are derivatives and adjoints."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.baselines.band_energy import WEIGHTED_RADIUS, BandEnergy
from surfexp.baselines.narrow_band import narrow_band
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.variational.separable_quadratic import convex_chan_vese, rof

FINE = icosphere(5).mesh
COARSE = BandEnergy(narrow_band(icosphere(3).mesh, 0.1, WEIGHTED_RADIUS))


def test_mass_is_the_area_of_the_sphere():
    """(1 + d)^2 under delta leaves an error of second order in the step."""
    errors = []
    for step in (0.16, 0.08, 0.04):
        energy = BandEnergy(narrow_band(FINE, step, WEIGHTED_RADIUS))
        assert energy.mass.min() > 0
        errors.append(abs(energy.mass.sum() / (4 * np.pi) - 1))
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 1.7).all(), errors


def test_total_variation_of_the_height_converges():
    """int |grad z| = pi^2 on the unit sphere, by the full gradient and by the projected one, with second order."""
    full, projected = [], []
    for step in (0.16, 0.08, 0.04):
        energy = BandEnergy(narrow_band(FINE, step, WEIGHTED_RADIUS))
        positions = energy.band.positions
        height = positions[:, 2] / np.linalg.norm(positions, axis=1)
        full.append(abs(energy.total_variation(height) / np.pi**2 - 1))
        load = np.empty_like(height)
        projected.append(abs(energy.projected_load(positions[:, 2].copy(), 1e-9, load) / np.pi**2 - 1))
    for errors in (full, projected):
        assert errors[-1] < 1e-3, errors
        assert np.log2(errors[0] / errors[-1]) / 2 > 1.7, errors


def test_projection_removes_the_normal_derivative():
    """The distance varies along normals only: its projected variation is a small part of its whole one."""
    energy = BandEnergy(narrow_band(FINE, 0.05, WEIGHTED_RADIUS))
    load = np.empty(energy.band.node_count)
    inner = energy.projected_load(energy.band.distance.copy(), 1e-9, load)
    assert inner < 0.2 * energy.total_variation(energy.band.distance)


def test_load_is_the_derivative_of_the_projected_variation():
    rng = np.random.default_rng(1)
    values, direction = rng.normal(size=(2, COARSE.band.node_count))
    load, scratch = np.empty_like(values), np.empty_like(values)
    at = COARSE.projected_load(values, 0.5, load)
    remainders = []
    for size in (1e-2, 5e-3, 2.5e-3):
        remainders.append(
            abs(COARSE.projected_load(values + size * direction, 0.5, scratch) - at - size * load @ direction)
        )
    assert (np.log2(np.array(remainders[:-1]) / remainders[1:]) > 1.8).all(), remainders


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_dual_load_is_the_adjoint_and_the_bound_holds(seed):
    rng = np.random.default_rng(seed)
    energy, band = COARSE, COARSE.band
    values, start = rng.normal(size=(2, band.node_count)) * rng.uniform(0.1, 10)
    dual, load = rng.normal(size=(band.node_count, 3)), np.empty(band.node_count)
    dual[band.forward < 0] = 0
    energy.dual_ascent(0.3, start, dual, load)
    differences = np.where(band.forward >= 0, values[band.forward] - values[:, None], 0) / band.step
    assert np.linalg.norm(dual, axis=1).max() <= 1 + 1e-12
    assert load @ values == pytest.approx(np.einsum("k,kd,kd->", energy.cells, dual, differences), abs=1e-9)
    assert energy.cells @ (differences**2).sum(axis=1) <= energy.difference_bound * energy.mass @ values**2
    assert energy.total_variation(values) >= load @ values - 1e-9


def test_a_data_term_is_extended():
    mesh = icosphere(3).mesh
    image = mesh.vertices[:, 2]
    on_surface = rof(mesh.vertex_areas, image, 3.0)
    on_band = COARSE.fidelity(on_surface)
    constant = np.full(COARSE.band.node_count, 2.0)
    assert on_band.value(constant) == pytest.approx(on_surface.value(np.full(len(image), 2.0)), rel=0.02)
    slope = convex_chan_vese(mesh.vertex_areas, image)
    share = COARSE.mass.sum() / mesh.area
    assert COARSE.fidelity(slope).trivial_energy == pytest.approx(slope.trivial_energy * share)
    with pytest.raises(ValueError, match="at least 2 are needed"):
        BandEnergy(narrow_band(mesh, 0.1, 1.8))
    with pytest.raises(ValueError, match="takes one channel"):
        COARSE.fidelity(rof(mesh.vertex_areas, mesh.vertices, 3.0))
