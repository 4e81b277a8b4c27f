"""Every prox by Moreau's identity and by its definition; every dual value by the Fenchel inequality."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.fidelity import Fidelity
from surfexp.variational.heat_blur import HeatBlur
from surfexp.variational.separable_quadratic import convex_chan_vese, inpainting, rof
from surfexp.variational.simplex_labelling import SimplexLabelling

OPERATOR = fem(icosphere(1).mesh)
MASS = OPERATOR.mass
RNG = np.random.default_rng(0)
IMAGE = RNG.normal(size=len(MASS))
KNOWN = RNG.random(len(MASS)) < 0.6
FIDELITIES: list[Fidelity] = [
    rof(MASS, IMAGE, 3.0),
    rof(MASS, RNG.normal(size=(len(MASS), 3)), 3.0),
    inpainting(MASS, IMAGE, KNOWN, 3.0),
    convex_chan_vese(MASS, IMAGE),
    SimplexLabelling(MASS, RNG.normal(size=(len(MASS), 4))),
    HeatBlur(OPERATOR, IMAGE, 3.0, 0.05),
]
NAMES = ["rof", "vector rof", "inpainting", "chan-vese", "simplex", "blur"]


def weighted(a: np.ndarray) -> np.ndarray:
    return (MASS * a.T).T


@pytest.mark.parametrize("fidelity", FIDELITIES, ids=NAMES)
@settings(deadline=None, max_examples=15)
@given(seed=st.integers(0, 10**6), step=st.floats(0.05, 20.0))
def test_moreau_identity(fidelity: Fidelity, seed: int, step: float) -> None:
    """At x = prox(v), d = m (v - x)/step is a subgradient: H(x) = <d, x> + D(-d), Fenchel's equality."""
    v = 2.0 * np.random.default_rng(seed).normal(size=fidelity.shape)
    x = fidelity.prox(v, step)
    d = weighted(v - x) / step
    left, right = fidelity.value(x), np.vdot(d, x) + fidelity.dual_value(-d)
    size = 1.0 + abs(left) + np.abs(d * x).sum()
    assert np.isfinite(left)
    assert abs(left - right) <= 1e-9 * size


@pytest.mark.parametrize("fidelity", FIDELITIES, ids=NAMES)
@settings(deadline=None, max_examples=15)
@given(seed=st.integers(0, 10**6), step=st.floats(0.05, 20.0), near=st.sampled_from([1e-4, 1e-2, 1.0]))
def test_prox_is_the_minimiser(fidelity: Fidelity, seed: int, step: float, near: float) -> None:
    """F(y) >= F(x) + |y - x|_m^2 / (2 step) for F = H + |. - v|_m^2 / (2 step), x = prox(v), y in the domain."""
    rng = np.random.default_rng(seed)
    v = rng.normal(size=fidelity.shape)
    x = fidelity.prox(v, step)
    y = x + near * (fidelity.prox(rng.normal(size=fidelity.shape), 1.0) - x)

    def distance(a: np.ndarray, b: np.ndarray) -> float:
        return float(weighted((a - b) ** 2).sum() / (2 * step))

    least, other = fidelity.value(x) + distance(x, v), fidelity.value(y) + distance(y, v)
    assert other - least >= distance(x, y) * (1 - 1e-6) - 1e-11 * (1 + abs(least))


@pytest.mark.parametrize("fidelity", FIDELITIES, ids=NAMES)
@settings(deadline=None, max_examples=15)
@given(seed=st.integers(0, 10**6))
def test_dual_value_is_a_lower_bound(fidelity: Fidelity, seed: int) -> None:
    rng = np.random.default_rng(seed)
    x, d = fidelity.prox(rng.normal(size=fidelity.shape), 1.0), weighted(rng.normal(size=fidelity.shape))
    assert fidelity.dual_value(d) <= np.vdot(d, x) + fidelity.value(x) + 1e-10
    best = fidelity.primal_from_dual(d)
    if best is not None:
        assert np.vdot(d, best) + fidelity.value(best) == pytest.approx(fidelity.dual_value(d), rel=1e-10)


def test_linear_term_without_box_has_no_bound() -> None:
    fidelity = inpainting(MASS, IMAGE, KNOWN, 3.0)
    free = type(fidelity)("free", MASS, fidelity.weight, fidelity.target, fidelity.slope)
    assert free.dual_value(MASS) == -np.inf
    assert fidelity.value(IMAGE + 100.0) == np.inf


def test_bad_weights_are_refused() -> None:
    for bad in (0.0, -1.0, np.inf, np.nan):
        with pytest.raises(ValueError, match="mu is"):
            rof(MASS, IMAGE, bad)
    with pytest.raises(ValueError, match="0 of 42 vertices are known"):
        inpainting(MASS, IMAGE, np.zeros(len(MASS), dtype=bool), 1.0)
