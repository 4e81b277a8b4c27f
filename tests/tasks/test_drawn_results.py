"""Each result of the face is drawn on its surface: what a picture shows is what the result holds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import nibabel
import numpy as np
import pandas as pd
import pytest

import surfexp as sx
from surfexp.mesh.label_map import LabelMap
from surfexp.tasks.map_rows import rows_of_maps
from surfexp.tasks.maps_of_result import maps_of
from surfexp.tasks.risk_curve import RiskCurve
from surfexp.tasks.shown import shown_surfaces

BODY = sx.shape("ellipsoid", levels=3)
OTHER = sx.shape("ellipsoid", levels=2)
SIZES = {"width": 300}


def noisy() -> sx.Surface:
    from dataclasses import replace

    height = BODY.mesh.vertices[:, 2] + np.random.default_rng(0).normal(0.0, 0.05, len(BODY.mesh.vertices))
    return replace(BODY, scalars={"height": height})


def test_eigenfunctions_are_rows_in_their_root_mean_square_with_nodal_lines() -> None:
    system = sx.eigenpairs(BODY, 5)
    rows = shown_surfaces(BODY, system)
    assert len(rows) == 4 and [row[0].title.split(",")[0] for row in rows] == [f"mode {k}" for k in (1, 2, 3, 4)]
    for k, (shown,) in enumerate(rows, 1):
        assert shown.values is not None and shown.contours and shown.scale.limits == (-2.0, 2.0)
        np.testing.assert_allclose(np.sqrt(np.mean(shown.values**2)), 1.0, atol=1e-12)
        np.testing.assert_allclose(np.corrcoef(shown.values, system.vectors[:, k])[0, 1], 1.0, atol=1e-12)
    assert len({row[0].scale.label for row in rows}) == 1  # one bar for all


def test_a_map_is_shown_before_and_after_in_the_same_colours_with_what_was_removed() -> None:
    surface = noisy()
    clean = sx.denoise(surface, "height", method="rof")
    before, after, removed = (row[0] for row in shown_surfaces(surface, clean))
    assert before.scale.limits == after.scale.limits and removed.scale.limits != before.scale.limits
    np.testing.assert_allclose(before.values - after.values, removed.values, atol=1e-14)
    np.testing.assert_array_equal(before.values, surface.scalars["height"])
    # what was given counts, whatever the surface carries under its name
    other = replace(surface, scalars={"height": np.zeros(len(BODY.mesh.vertices))})
    for one in (BODY, other):
        np.testing.assert_array_equal(shown_surfaces(one, clean)[0][0].values, surface.scalars["height"])
    path = sx.denoise_path(surface, "height", weights=(0.5, 2.0), tolerance=1e-2).at(1.0)
    for made in (path, sx.smooth(surface, "height", 0.3), sx.denoise(surface, "height")):
        np.testing.assert_allclose(made.given, surface.scalars["height"], rtol=1e-15)


def test_a_correspondence_carries_the_colours_of_the_source() -> None:
    found = sx.distance(BODY, OTHER, n=4)
    (row,) = shown_surfaces([BODY, OTHER], found)
    assert row[0].values is not None and row[1].values is not None
    np.testing.assert_array_equal(row[1].values, row[0].values[found.correspondence])
    assert len(np.unique(row[0].values, axis=0)) > 100
    with pytest.raises(ValueError, match=r"give \[source, target\]"):
        found.plot([OTHER, BODY])
    with pytest.raises(ValueError, match=r"give \[source, target\]"):
        found.plot(BODY)


def test_a_skeleton_is_drawn_with_its_nodes() -> None:
    skeleton = sx.reeb_graph(BODY, BODY.mesh.vertices[:, 0])
    ((shown,),) = shown_surfaces(BODY, skeleton)
    assert shown.values is None and len(shown.contours) >= 2


@pytest.mark.parametrize(
    "make",
    [
        lambda one: sx.eigenpairs(one, 3),
        lambda one: sx.denoise(one, "height", method="rof"),
        lambda one: sx.segment(one, "height"),
        lambda one: sx.noise(one, "height"),
        lambda one: sx.null_maps(one, "height", 2, seed=0),
        lambda one: sx.compare_maps(one, "height", one.mesh.vertices[:, 0], count=9, modes=25),
        lambda one: sx.permutation_test(one, np.random.default_rng(0).standard_normal((len(one.mesh.vertices), 4))),
        lambda one: sx.reeb_graph(one, "height"),
        lambda one: sx.align(one, one, 2),
    ],
)
def test_every_result_has_a_plot_and_a_view(make: Any) -> None:
    surface = noisy()
    result = make(surface)
    pixels = result.plot(surface, **SIZES).figure.pixels
    assert pixels.shape[1] == 300 and len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50
    assert "<canvas" in (page := sx.view(surface, result).html()) or "scene" in page


def test_a_result_on_two_surfaces_is_refused() -> None:
    with pytest.raises(ValueError, match="belongs to 1 surface, 2 are given"):
        rows_of_maps(sx.eigenpairs(BODY, 3), [BODY, OTHER])


def test_what_was_removed_has_the_unit_of_its_map_and_the_filter_its_name() -> None:
    ball = sx.shape("icosphere", levels=4)
    noisy = 2.5 + 0.3 * np.random.default_rng(0).standard_normal(len(ball.vertices))
    brain = sx.Surface(ball.mesh, unit="mm", scalars={"lh.thickness": noisy})
    clean = sx.denoise(brain, "lh.thickness")
    ((before, after, removed),) = sx.plot(brain, clean, width=300).views
    assert before.scale.title == after.scale.title == "lh.thickness (mm)" and removed.scale.title == "removed (mm)"
    assert "auto" not in after.title and clean.certificate["chosen"].replace("_", " ") in after.title


@pytest.mark.parametrize("offset", [-0.5, -0.2, 0.0, 3.0])
def test_what_is_compared_has_the_same_colours_and_white_means_zero(offset: float) -> None:
    """Before and after, the weights of a path, the columns of a series and two sides: whatever the signs of each alone."""
    ball = sx.shape("icosphere", levels=3)
    noisy = (
        (ball.mesh.vertices[:, 0] > 0.2) + offset + 0.3 * np.random.default_rng(0).standard_normal(len(ball.vertices))
    )
    own = sx.Surface(ball.mesh, scalars={"map": noisy})
    path = sx.denoise_path(ball, noisy, noise=0.3, weights=(0.2, 5.0), tolerance=1e-2)
    series = np.column_stack([noisy, np.abs(noisy) + 1.0])
    pictures = [
        sx.plot(own, sx.denoise(own, "map"), width=300),
        path.plot(ball, width=300),
        sx.plot(ball, series, width=300),
    ]
    pictures.append(sx.plot([ball, ball], [noisy, np.abs(noisy) + 1.0], label="map", width=300))
    for picture, compared in zip(pictures, (2, 4, 2, 2), strict=True):
        scales = [view.scale for row in picture.views for view in row][:compared]
        assert len(set(scales)) == 1
        limits = scales[0].limits
        assert not scales[0].diverging or limits is None or limits[0] == -limits[1]


def test_colours_in_bytes_and_in_shares_are_the_same() -> None:
    shares = np.tile([0.8, 0.2, 0.0], (len(BODY.mesh.vertices), 1))
    drawn = [sx.plot(BODY, colors, **SIZES).figure.pixels for colors in (shares, np.rint(255.0 * shares))]
    assert np.array_equal(*drawn) and drawn[0].reshape(-1, 3).min(axis=0)[2] == 0


def test_limits_that_are_not_as_far_from_zero_on_both_sides_have_no_diverging_colours() -> None:
    ball = sx.shape("icosphere", levels=2)
    for limits, diverging in (((-1.0, 1.0), True), ((-0.5, 1.0), False), (None, True)):
        ((view,),) = sx.plot(ball, ball.mesh.vertices[:, 2], limits=limits, width=200).views
        assert view.scale.diverging == diverging


def test_a_file_that_places_its_surface_in_a_brain_or_a_scanner_is_in_millimetres(tmp_path: Path) -> None:
    ball = sx.shape("icosphere", levels=2)
    sx.write(tmp_path / "named.surf.gii", sx.Surface(ball.mesh, hemisphere="left"))
    sx.write(tmp_path / "any.surf.gii", ball)
    scanner = {"head": [2, 0, 20], "valid": "1  # volume info valid", "filename": "T1.mgz", "volume": [256] * 3}
    scanner |= {"voxelsize": [1.0] * 3, "xras": [-1, 0, 0], "yras": [0, 0, -1], "zras": [0, 1, 0], "cras": [0, 0, 0]}
    for name, volume in (("lh.white", scanner), ("lh.bare", None)):
        nibabel.freesurfer.write_geometry(tmp_path / name, ball.vertices, ball.faces, volume_info=volume)
    units = {name: sx.read(tmp_path / name).unit for name in ("named.surf.gii", "any.surf.gii", "lh.white", "lh.bare")}
    assert units == {"named.surf.gii": "mm", "any.surf.gii": "", "lh.white": "mm", "lh.bare": ""}
    assert sx.read(tmp_path / "lh.white", unit="cm").unit == "cm"
    thick = replace(sx.read(tmp_path / "lh.white"), scalars={"thickness": np.linspace(1.0, 4.0, len(ball.vertices))})
    assert sx.plot(thick, "thickness", width=300).views[0][0].scale.title == "thickness (mm)"


def test_labels_may_be_texts_or_numbers_with_nan_and_are_refused_in_one_line() -> None:
    height = BODY.mesh.vertices[:, 2]
    keys = np.where(height > 0, 2, 1)
    words = np.where(keys == 1, "south", "north")
    ((shown,),) = shown_surfaces(BODY, words)
    assert shown.labels is not None and shown.labels.names == ("north", "south")
    assert np.array_equal(np.array(shown.labels.names)[shown.labels.index], words)
    lines = sx.plot(BODY, height, borders=LabelMap(keys, {1: "1", 2: "2"}), **SIZES).figure.pixels
    for given in (keys.astype(float), words, pd.Categorical(words), pd.Series(keys.astype(float))):
        assert np.array_equal(sx.plot(BODY, height, borders=given, **SIZES).figure.pixels, lines)
    with pytest.raises(ValueError, match=r"^borders = 'none': give labels by name[^\n]*$"):
        sx.plot(BODY, height, borders="none", **SIZES)
    with pytest.raises(TypeError, match=r"skeleton is a result of sx.reeb_graph, not ndarray"):
        sx.plot(BODY, height, skeleton=height, **SIZES)


def test_a_curve_is_a_drawing_too_and_a_refusal_names_what_it_can_be(tmp_path: Path) -> None:
    curve = RiskCurve(np.array([0.5, 1.0, 2.0]), np.array([0.3, 0.2, 0.4]), np.full(3, 0.01)).plot(300)
    curve.save(tmp_path / "curve.svg")
    with pytest.raises(ValueError, match=r"no \.pdf drawing: choose \.png or \.svg"):
        curve.save(tmp_path / "curve.pdf")


def test_modes_have_one_number_in_pictures_and_files_whatever_they_begin_with() -> None:
    disk = sx.shape("disk")
    window, held = sx.Spectrum(BODY).between(3.0, 20.0), sx.eigenpairs(disk, 4, boundary="dirichlet")
    below = int((sx.eigenpairs(BODY, 30).values < 3.0).sum())
    aligned = sx.align(BODY, BODY, 3)
    for surface, modes, first in (
        (BODY, window, below),
        (disk, held, 1),
        (BODY, aligned, 1),
        (BODY, sx.eigenpairs(BODY, 3), 0),
    ):
        assert list(maps_of(modes))[:2] == [f"mode {first}", f"mode {first + 1}"]
        title = shown_surfaces(surface, modes)[0][0].title.removeprefix("aligned ")
        assert title.split(",")[0] == f"mode {first or 1}"  # a constant is not drawn


def test_a_window_without_eigenvalues_is_shown_and_not_drawn(tmp_path: Path) -> None:
    empty = sx.Spectrum(sx.shape("icosphere", levels=3)).between(3.0, 5.0)
    assert repr(empty).startswith("<EigenSystem: 0 eigenpairs, complete yes")
    for use in (lambda: sx.plot(BODY, empty), lambda: sx.write(tmp_path / "modes.func.gii", empty)):
        with pytest.raises(ValueError, match="there are 0 eigenpairs, a picture or a map needs 1: take wider bounds"):
            use()
