"""Missing eigenpairs are found where they were taken away, and counted with their interval."""

import numpy as np
import pytest
from scipy.linalg import eigh

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.contract.member import Member
from surfexp.mesh.coarsening import coarse
from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp.statistics.statistic import Statistic
from surfexp_studies.missing_pairs.adversarial_meshes import side_by_side, with_slivers
from surfexp_studies.missing_pairs.missing_pairs import compared, missing_by_kind, missing_pairs

BALL = icosphere(2)
OPERATOR = fem(BALL.mesh)
CERTIFIED = surface_spectrum(BALL, OPERATOR, count=40)


def test_what_runs_are_held_against_is_the_spectrum_of_dense_algebra() -> None:
    dense = eigh(stiffness(OPERATOR).toarray(), mass_matrix(OPERATOR).toarray(), eigvals_only=True)
    np.testing.assert_allclose(CERTIFIED.values, dense[:40], atol=1e-10)


@pytest.mark.parametrize("gone", [[], [0], [5], [10, 11], [29]])
def test_pairs_that_were_taken_away_are_missing(gone: list[int]) -> None:
    kept = np.setdiff1d(np.arange(30), gone)
    found = compared(CERTIFIED.values[kept], CERTIFIED.vectors[:, kept], CERTIFIED, mass_matrix(OPERATOR))
    # the last of those asked for cannot be missed, since nothing above it was returned
    assert found[:2] == (len(gone) if gone != [29] else 0, 0)
    assert found[2] < 1e-12 and found[3] < 1e-6


def test_a_pair_that_comes_twice_and_one_that_is_wrong_are_seen() -> None:
    mass, twice = mass_matrix(OPERATOR), [0, 1, 1, 2, 3, 4]
    missing, surplus, _, _ = compared(CERTIFIED.values[twice], CERTIFIED.vectors[:, twice], CERTIFIED, mass)
    assert surplus == 0 or missing == 0
    values, vectors = CERTIFIED.values[:30].copy(), CERTIFIED.vectors[:, :30].copy()
    values[8], vectors[:, 8] = (
        0.5 * (values[8] + values[9]) + 0.1,
        np.random.default_rng(0).standard_normal(len(vectors)),
    )
    _, _, error, sine = compared(values, vectors, CERTIFIED, mass)
    assert error > 1e-3 and sine > 0.5


def test_a_simple_value_that_comes_twice_is_a_surplus() -> None:
    ring = torus(30, 12)
    operator = fem(ring.mesh)
    system = surface_spectrum(ring, operator, count=30)
    twice = [0, 0, *range(1, 20)]
    assert compared(system.values[twice], system.vectors[:, twice], system, mass_matrix(operator))[1] == 1


def test_runs_on_a_rough_sphere_are_complete_and_a_short_spectrum_is_refused() -> None:
    """Without equal eigenvalues; on the icosphere itself runs for 30 pairs leave one of five equal ones out."""
    rough = add_vertex_noise(BALL, 0.02)
    operator = fem(rough.mesh)
    found = missing_pairs(operator, surface_spectrum(rough, operator, count=40), (10, 30), 2)
    assert found.metrics["runs"] == 4 and found.metrics["missing"] == 0
    assert found.metrics["value_error"] < 1e-10 and found.metrics["span_sine"] < 1e-6
    with pytest.raises(ValueError, match="has 40 values, complete True; more than 40 are needed"):
        missing_pairs(OPERATOR, CERTIFIED, (10, 40))


def test_of_several_runs_the_worst_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = iter([(0.0, 0.0, 1e-9, 0.1), (1.0, 0.0, 1e-3, 0.4), (0.0, 2.0, 1e-6, 0.2), (0.0, 0.0, 0.0, 0.3)])
    monkeypatch.setattr("surfexp_studies.missing_pairs.missing_pairs.compared", lambda *_: next(runs))
    told = missing_pairs(OPERATOR, CERTIFIED, (10, 20), 2).metrics
    assert told["runs_with_missing"] == told["runs_with_surplus"] == told["missing"] == 1
    assert told["value_error"] == 1e-3 and told["span_sine"] == 0.4


def test_the_interval_of_no_event_and_of_some() -> None:
    names = ("runs_with_surplus", "runs_without_result", "missing", "value_error", "span_sine")

    def found(missing: int) -> Statistic:
        return Statistic("x", metrics={"runs": 60.0, "runs_with_missing": float(missing)} | dict.fromkeys(names, 0.0))

    members = {Member(str(i), "cortex"): found(0) for i in range(2)} | {Member("t", "torus"): found(3)}
    table = missing_by_kind(members)
    assert table.rows == ("cortex", "torus", "all") and table.metrics["runs"] == 180
    share = table.columns["missing_share"]
    np.testing.assert_allclose(share[0], [0.0, 0.0, 100 * (1 - 0.025 ** (1 / 120))])
    assert share[1, 1] < 5.0 == share[1, 0] < share[1, 2]


def test_adversarial_meshes_are_what_they_say() -> None:
    cortex = fsaverage5("left", "white")
    first, second = (coarse(cortex, 900, seed, thinnest=1.0) for seed in (0, 1))
    for surface in (first, second):
        assert len(surface.mesh.vertices) == 900 and surface.mesh.component_count == 1
        assert surface.mesh.boundary_loops and (surface.mesh.edge_face_counts <= 2).all()
    assert not np.array_equal(first.mesh.vertices, second.mesh.vertices)
    assert coarse(cortex, 900).mesh.is_closed
    with pytest.raises(ValueError, match="no map 'thickness'"):
        coarse(BALL, 100, thinnest=1.0)
    pair = side_by_side(BALL)
    assert pair.mesh.component_count == 2 and pair.mesh.is_closed
    values = surface_spectrum(pair, fem(pair.mesh), count=20).values
    np.testing.assert_allclose(values[::2], values[1::2], atol=1e-9)
    np.testing.assert_allclose(values[::2], CERTIFIED.values[:10], atol=1e-8)
    for angle in (0.1, 1e-5):
        flat = with_slivers(torus(40, 16), angle).mesh
        corners = flat.vertices[flat.faces]
        sides = np.sort(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2), axis=1)
        least = np.degrees(np.arcsin(2.0 * flat.areas / (sides[:, 1] * sides[:, 2]))).min()
        assert least == pytest.approx(angle, rel=1e-3)
    with pytest.raises(ValueError, match="angle is 40"):
        with_slivers(BALL, 40.0)
