"""scikit-learn transformers of surfaces."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from sklearn.base import clone
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.utils import estimator_checks

import surfexp as sx
from surfexp.embedding.spectral_embedding import SpectralEmbedding
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.distances import search_limit

BODY = sx.shape("icosphere", levels=3)


def stretched(*factors: float) -> Surface:
    return Surface(TriangleMesh(BODY.mesh.vertices * factors, BODY.mesh.faces))


BODIES = [stretched(1, 1.2, 1.5), stretched(1, 1.3, 1.9), stretched(1, 1.1, 2.6)]
TRANSFORMERS = [sx.ShapeDNA(n=6), sx.NodalCounts(n=6), sx.SpectralDistance(n=4)]


def test_shape_dna_is_that_of_eigenpairs_and_free_of_size() -> None:
    rows = sx.ShapeDNA(n=6).fit_transform(BODIES)
    system = sx.eigenpairs(BODIES[0], 7)
    published = sx.ShapeDNA(n=6, reweighted=False).fit_transform(BODIES)
    assert published[0] == pytest.approx(system.values[1:] * BODIES[0].mesh.area, rel=1e-9)
    assert rows * np.arange(1.0, 7.0) == pytest.approx(published)
    assert sx.ShapeDNA(n=6).fit_transform([stretched(3, 3.6, 4.5)])[0] == pytest.approx(rows[0], rel=1e-8)
    by_volume = sx.ShapeDNA(n=6, normalisation="volume")
    assert by_volume.fit_transform([stretched(3, 3.6, 4.5)])[0] == pytest.approx(by_volume.transform(BODIES[:1])[0])


def test_counts_obey_courant() -> None:
    counts = sx.NodalCounts(n=6).fit_transform(BODIES)
    assert counts.shape == (3, 6) and (counts >= 2).all() and (counts <= np.arange(2, 8)).all()


def test_distances_are_a_matrix_and_equal_those_of_the_function() -> None:
    measure = sx.SpectralDistance(n=4)
    matrix = measure.fit_transform(BODIES)
    assert np.array_equal(matrix, matrix.T) and not matrix.diagonal().any()
    assert matrix[1, 0] == pytest.approx(sx.distance(BODIES[1], BODIES[0], n=4).value, rel=1e-9)
    rows = measure.transform([BODIES[2]])
    assert rows[0] == pytest.approx(matrix[2], abs=1e-9)
    searched = sx.SpectralDistance(n=4, limit=1000)
    assert searched.fit_transform(BODIES) == pytest.approx(matrix, rel=1e-9) and searched.proved_ == 1.0
    rushed = sx.SpectralDistance(n=6, limit=2)
    assert (rushed.fit_transform(BODIES) >= sx.SpectralDistance(n=6).fit_transform(BODIES) - 1e-9).all()
    assert rushed.proved_ <= 1.0


def test_a_search_without_a_limit_ends_in_about_a_minute() -> None:
    """The number of evaluations follows from the number of points alone, so that a result repeats on any machine."""

    def sized(count: int) -> SpectralEmbedding:
        return SpectralEmbedding(np.zeros((count, 1)), np.full(count, 1.0 / count), np.ones(1))

    limits = [search_limit(sized(count), sized(count)) for count in (100, 1_000, 7_000, 10_000, 100_000)]
    assert limits == [2000, 2000, 408, 200, 100]
    one, other = sx.shape("ellipsoid", levels=3), sx.shape("ellipsoid", levels=3, semiaxes=(1.0, 0.7, 0.4))
    stopped, whole = sx.distance(one, other, n=8, limit=2), sx.distance(one, other, n=8)
    assert whole.optimal and stopped.lower_bound <= whole.value + 1e-12 <= stopped.value + 2e-12


def test_paths_and_pipelines(working_folder: Path) -> None:
    names = [f"{k}.ply" for k in range(3)]
    for name, body in zip(names, BODIES, strict=True):
        sx.write(name, body)
    pipeline = make_pipeline(sx.ShapeDNA(n=3), StandardScaler())
    assert pipeline.fit_transform(names) == pytest.approx(pipeline.fit_transform(BODIES), abs=1e-6)


@pytest.mark.parametrize("transformer", TRANSFORMERS, ids=lambda it: type(it).__name__)
def test_the_checks_of_scikit_learn_that_give_no_data(transformer) -> None:
    name = type(transformer).__name__
    for check in (
        estimator_checks.check_parameters_default_constructible,
        estimator_checks.check_no_attributes_set_in_init,
        estimator_checks.check_get_params_invariance,
        estimator_checks.check_set_params,
        estimator_checks.check_estimator_tags_renamed,
        estimator_checks.check_estimator_repr,
    ):
        check(name, clone(transformer))
    with pytest.raises(ValueError, match="n = 0, at least 1"):
        clone(transformer).set_params(n=0).fit(BODIES)


@pytest.mark.parametrize("transformer", [sx.ShapeDNA(n=3), sx.NodalCounts(n=3)], ids=["ShapeDNA", "NodalCounts"])
def test_no_surface_is_no_row(transformer) -> None:
    width = transformer.fit_transform(BODIES).shape[1]
    assert transformer.fit_transform([]).shape == (0, width)


@pytest.mark.parametrize("count", [0, -3, 2.5, "7", None])
def test_a_number_of_modes_that_is_none_is_refused_before_any_work(count: object) -> None:
    with pytest.raises(ValueError, match=re.escape(f"n = {count!r}")):
        sx.ShapeDNA(n=count).fit([])


def test_a_surface_that_is_unfit_is_named() -> None:
    points, faces = BODY.mesh.vertices, BODY.mesh.faces
    two = np.vstack([points, points + 3.0]), np.vstack([faces, faces + len(points)])
    with pytest.raises(ValueError, match=r"^surface 1 \(lost\.ply\): "):
        sx.ShapeDNA(n=3).fit_transform([BODY, "lost.ply"])
    with pytest.raises(ValueError, match=r"^surface 2: .* 2 pieces"):
        sx.SpectralDistance(n=3).fit([BODY, BODY, two])


@pytest.mark.parametrize("transformer", TRANSFORMERS, ids=lambda it: type(it).__name__)
def test_another_number_of_modes_needs_another_fit(transformer) -> None:
    """Rows of half the length were joined in pairs, and distances taken between embeddings of two dimensions."""
    fitted = clone(transformer).fit(BODIES)
    fitted.set_params(n=3)
    with pytest.raises(ValueError, match=rf"n = 3, .* is fitted with n = {transformer.n}: fit it again"):
        fitted.transform(BODIES[:2])
    assert len(fitted.fit(BODIES).transform(BODIES[:2])) == 2


@pytest.mark.parametrize("transformer", TRANSFORMERS, ids=lambda it: type(it).__name__)
def test_columns_have_names_in_a_table(transformer) -> None:
    rows = clone(transformer).fit_transform(BODIES)
    table = (
        make_pipeline(clone(transformer), StandardScaler())
        .set_output(transform="pandas")
        .fit(BODIES)[:1]
        .transform(BODIES)
    )
    assert list(table.columns) == [f"{type(transformer).__name__.lower()}{k}" for k in range(rows.shape[1])]
    np.testing.assert_allclose(table.to_numpy(), rows, atol=1e-12)


def test_points_stand_for_large_surfaces(monkeypatch: pytest.MonkeyPatch) -> None:
    bodies = [sx.shape("ellipsoid", levels=3, semiaxes=(1.0, 1.3, 1.0 + size)) for size in (0.7, 1.5)]
    whole = sx.SpectralDistance(n=4).fit_transform(bodies)
    monkeypatch.setattr("surfexp.tasks.distances.LARGEST_PAIR", 1e5)
    monkeypatch.setattr("surfexp.tasks.distances.REPRESENTATIVES", 200)
    transformer = sx.SpectralDistance(n=4)
    few = transformer.fit_transform(bodies)
    assert transformer.proved_ == 0.0 and 0.0 < whole[0, 1] <= few[0, 1] <= 1.001 * whole[0, 1]
    assert transformer.transform(bodies).shape == (2, 2)
