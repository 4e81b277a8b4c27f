"""Views and pictures from Python: the same surfaces, maps, labels and lines, in a page that asks nobody."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.figures.camera import fit_camera
from surfexp.figures.contours import Contours
from surfexp.figures.labelling import border_lines, label_colors, labelling
from surfexp.figures.render import SurfaceView, draw
from surfexp.mesh.coloured_labels import ColouredLabels
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.viewing import check_view_target

sys.path.insert(0, str(Path(__file__).parents[1] / "report"))
from browser import PROGRAM, browser

BALL = sx.shape("icosphere", levels=4)
X, Y, Z = BALL.mesh.vertices.T
# Machado, Oliveira and Fernandes (2009): deuteranopia, in linear light
DEUTERANOPIA = np.array([[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]])


def test_a_page_holds_everything_and_its_policy_allows_no_host() -> None:
    page = sx.view(BALL, Z).html()
    policy = re.search(r'Security-Policy" content="([^"]*)"', page)
    assert policy is not None and policy[1].startswith("default-src 'none'; img-src data:; style-src 'sha256-")
    assert "unsafe" not in policy[1] and not re.search(r"(?:src|href)=[\"']?(?!data:)", page.split("<script>")[0])
    assert len(page) < 1_500_000


def test_a_notebook_gets_the_page_in_a_frame_whose_words_are_escaped() -> None:
    shown = sx.view(BALL, Z, title='"><img src=x>')._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "<img" not in shown and 'sandbox="allow-scripts"' in shown


@pytest.mark.parametrize("suffix", ["html", "png", "svg", pytest.param("pdf", marks=pytest.mark.slow)])
def test_a_view_is_saved_in_every_format(tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"ball.{suffix}"
    sx.view(BALL, Z).save(file)
    assert file.stat().st_size > 5000
    with pytest.raises(ValueError, match=r"\.html, \.png, \.svg, \.pdf"):
        sx.view(BALL).save(tmp_path / "ball.gif")


def test_integers_are_labels_and_floats_a_map() -> None:
    (drawn,) = sx.view(BALL, (Z > 0).astype(int) + 3).scene.surfaces
    assert drawn.fields[0].labels is not None and drawn.fields[0].labels.names == ("3", "4")
    (drawn,) = sx.view(BALL, (Z > 0).astype(float)).scene.surfaces
    assert drawn.fields[0].labels is None


def test_a_label_is_one_flat_colour_of_each_pixel_and_never_a_mean_of_two() -> None:
    square = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    view = SurfaceView(square, view="top", labels=labelling(np.array([0, 1, 2, 1])))
    pixels = draw(view, fit_camera(square, "top", (90, 90)), supersampling=1).reshape(-1, 3)
    assert len(np.unique(pixels[(pixels < 255).any(axis=1)], axis=0)) <= 3 + 3  # two ends of the occlusion at rims


def test_borders_run_from_cut_edges_to_the_middles_of_faces() -> None:
    face = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    lines = border_lines(face, np.array([0, 0, 1]))
    ends = {tuple(np.round(p, 6)) for p in lines.points[lines.segments].reshape(-1, 3)}
    assert ends == {(0.5, 0.5, 0.0), (0.0, 0.5, 0.0), (0.333333, 0.333333, 0.0)}
    assert len(border_lines(face, np.array([2, 2, 2])).segments) == 0


@pytest.mark.parametrize("casing, seen", [(1.5, True), (0.0, False)])
def test_a_boundary_is_seen_by_a_deuteranope_on_purple_with_its_casing_alone(casing: float, seen: bool) -> None:
    purple = np.tile((0.60, 0.40, 0.70), (len(Z), 1))
    contours = (Contours(Z, (0.0,), casing=casing),)
    camera = fit_camera(BALL.mesh, "front", (300, 300))
    with_line, without = (draw(SurfaceView(BALL.mesh, purple, "front", contours=c), camera) for c in (contours, ()))
    light = [
        np.clip((p / 255.0) ** 2.2 @ DEUTERANOPIA.T, 0, 1) @ (0.2126, 0.7152, 0.0722) for p in (with_line, without)
    ]
    contrast = (light[0] + 0.05) / (light[1] + 0.05)
    middle = contrast[140:160, 140:160].max()
    assert bool(middle >= 3.0) == seen


def test_the_first_six_label_colours_differ_for_a_deuteranope() -> None:
    seen = np.clip(label_colors(6) ** 2.2 @ DEUTERANOPIA.T, 0, 1) ** (1 / 2.2)
    apart = np.linalg.norm(seen[:, None] - seen[None], axis=2) + np.eye(6)
    assert apart.min() > 0.12


def test_what_lies_beyond_a_bar_is_said() -> None:
    picture = sx.plot(BALL, Z, limits=(-0.5, 0.5), width=400)
    assert re.search(r"% of the values lie beyond", picture.figure.caption)
    assert "beyond" not in sx.plot(BALL, Z, limits=(-1.0, 1.0), width=400).figure.caption


def test_the_side_of_a_hemisphere_is_what_it_says_and_not_where_it_lies() -> None:
    right = sx.Surface(TriangleMesh(BALL.mesh.vertices - (9.0, 0, 0), BALL.mesh.faces), hemisphere="right")
    views = sx.plot(right, width=400).views[0]
    assert [one.view for one in views] == [(0.0, 0.0), (180.0, 0.0)]
    assert [one.title for one in views] == ["lateral", "medial"]


def test_fsaverage5_is_a_hemisphere_seen_from_two_sides() -> None:
    pytest.importorskip("nilearn")
    brain = sx.shape("fsaverage5", hemisphere="left")
    assert brain.hemisphere == "left"
    (row,) = sx.plot(brain, "curv", width=400).views
    assert len(row) == 2 and row[0].scale.title == "curv (FreeSurfer, + in sulci) (1/mm)"


def test_several_surfaces_and_maps_are_panels() -> None:
    seen = sx.view([BALL, BALL], [Z, X])
    assert seen.scene.panels == [(0, 0), (1, 0)]
    assert sx.view(BALL, {"x": X, "z": Z}).scene.panels == [(0, 0), (0, 1)]
    with pytest.raises(ValueError, match="2 surfaces"):
        sx.view([BALL, BALL], [Z, X, Y])


@pytest.mark.skipif(PROGRAM is None, reason="needs chromium")
def test_a_browser_turns_labels_and_a_skeleton_and_asks_no_host(tmp_path: Path) -> None:
    file = tmp_path / "ball.html"
    torus = sx.shape("torus")
    graph = sx.reeb_graph(torus, torus.mesh.vertices[:, 0])
    keys = (torus.mesh.vertices[:, 2] > 0).astype(int)
    sx.view(torus, {"side": keys, "height": torus.mesh.vertices[:, 2]}, skeleton=graph).save(file)
    with browser(tmp_path / "profile") as tab:
        tab.call("Network.enable")
        tab.open(file)
        tab.wait("turning[0].panels.length === 2 && !waiting.size && !moving.size && !turning[0].button.disabled")
        assert tab.run("turning[0].panels[0].names.textContent") == "01"
        before = tab.run("turning[0].view.azimuth")
        box = "(({ left, top, width, height }) => [left + width / 2, top + height / 2])"
        x, y = tab.run(f"{box}(turning[0].panels[0].canvas.getBoundingClientRect())")
        tab.drag((x, y), (x + 40, y))
        assert tab.run("turning[0].view.azimuth") == before - 20.0
        assert [text for text in tab.complaints if "GL Driver" not in text] == []
        asked = [e["params"]["request"]["url"] for e in tab.events if e.get("method") == "Network.requestWillBeSent"]
        assert all(url.startswith(("file:", "data:", "blob:")) for url in asked)


def test_columns_of_a_map_are_a_slider_and_six_of_them_a_picture() -> None:
    series = np.outer(Z, np.arange(1.0, 25.0)) + 1000.0
    seen = sx.view(BALL, series, label="signal")
    (drawn,), panels = seen.scene.surfaces, seen.scene.panels
    (field,) = drawn.fields
    assert panels == [(0, 0)] and len(field.steps) == 24
    assert field.steps[7].values is not None and (field.steps[7].values == series[:, 7]).all()
    assert field.steps[0].name == "column 1 of 24" and field.steps[23].name == "column 24 of 24"
    # the slider says which column is shown, from the first one on
    assert field.start == 0 and seen.scene.titles == [""]
    picture = sx.plot(BALL, series, width=400)
    names = [one.title for row in picture.views for one in row]
    assert names == [f"column {k} of 24" for k in (1, 6, 10, 15, 19, 24)]
    # one bar for all, from the least to the greatest
    assert len({one.scale for row in picture.views for one in row}) == 1 and len(picture.views) == 2


def test_a_vertex_has_its_number_in_the_page_whatever_lies_before_it() -> None:
    faces = BALL.mesh.faces
    # two points without a face before and one not finite behind
    points = np.r_[[[0.0, 0.0, 0.0], [9.0, 9.0, 9.0]], BALL.mesh.vertices, [[np.nan, 0.0, 0.0]]]
    shown = sx.view((points, faces + 2), np.r_[5.0, 6.0, Z, 7.0])
    ((drawn,), (field,)) = shown.scene.surfaces, shown.scene.surfaces[0].fields
    assert np.array_equal(drawn.mesh.faces, faces + 2) and np.array_equal(drawn.mesh.vertices[2:-1], BALL.mesh.vertices)
    assert np.abs(drawn.mesh.vertices).max() <= 1.0  # the box is that of the ball
    values = field.steps[0].values
    assert values is not None and np.array_equal(values, np.r_[np.nan, np.nan, Z, np.nan], equal_nan=True)
    assert field.scale.limits is None or field.scale.limits[1] <= 1.0
    labels = sx.view((points, faces + 2), np.r_[8, 8, (Z > 0).astype(int), 8]).scene.surfaces[0].fields[0].labels
    assert labels is not None and labels.index[:2].tolist() == [-1, -1]


def test_a_copy_that_repair_made_tells_the_vertex_of_the_file(tmp_path: Path) -> None:
    lower = sx.shape("icosphere", levels=1).mesh
    # two balls that share a vertex: repair splits it
    opposite, count = int(np.argmin(lower.vertices @ lower.vertices[0])), len(lower.vertices)
    points = np.r_[lower.vertices, np.delete(lower.vertices + 2.0 * lower.vertices[0], opposite, axis=0)]
    number = np.insert(np.arange(count, len(points)), opposite, 0)
    sx.write(tmp_path / "two.ply", (points, np.r_[lower.faces, number[lower.faces]]))
    scan = sx.read(tmp_path / "two.ply", repair=True)
    (drawn,) = sx.view(scan, scan.mesh.vertices[:, 2]).scene.surfaces
    assert scan.file is not None and len(scan.mesh.vertices) > len(points)
    assert drawn.origin is not None and drawn.origin.max() < len(points)
    assert sx.view(BALL, Z).scene.surfaces[0].origin is None


def test_a_label_has_one_colour_on_all_surfaces_of_a_picture() -> None:
    keys = 1 + np.arange(len(Z)) % 3
    few = np.where(keys == 1, 2, keys)
    picture = sx.plot([BALL, BALL], [keys, few], width=400)
    first, second = (view.labels for view in picture.views[0])
    assert first is not None and second is not None and second.names == ("2", "3")
    assert np.array_equal(first.colors[1:], second.colors)
    brain = sx.Surface(BALL.mesh, hemisphere="left"), sx.Surface(BALL.mesh, hemisphere="right")
    seen = sx.view(list(brain), [keys, few]).scene.surfaces
    colors = [one.fields[0].labels.colors for one in seen if one.fields[0].labels is not None]
    assert np.array_equal(colors[0][1:], colors[1])
    # a colour of an atlas counts for all
    atlas = ColouredLabels(few, {2: "2", 3: "3"}, {3: (0.25, 0.5, 0.75)})
    first, second = (view.labels for view in sx.plot([BALL, BALL], [keys, atlas], width=400).views[0])
    assert first is not None and second is not None
    assert first.colors[2].tolist() == second.colors[1].tolist() == [0.25, 0.5, 0.75]
    assert np.array_equal(first.colors[1], second.colors[0])


def test_a_series_in_a_file_is_a_slider_and_maps_with_names_are_panels(tmp_path: Path) -> None:
    series = np.outer(Z, np.arange(1.0, 9.0))
    np.savetxt(tmp_path / "series.csv", series, delimiter=",")
    (drawn,) = sx.view(BALL, str(tmp_path / "series.csv")).scene.surfaces
    assert [step.name for step in drawn.fields[0].steps] == [f"column {k} of 8" for k in range(1, 9)]
    labels = (Z > 0).astype(int)
    parcels = sx.parcels(BALL, series[:, :2], labels)
    seen = sx.view(BALL, parcels).scene
    assert len(seen.panels) == 2 and len({one.scale.limits for one in seen.surfaces[0].fields}) == 2


def test_three_columns_are_colours_only_where_they_can_be() -> None:
    red = np.tile([0.9, 0.1, 0.1], (len(Z), 1))
    ((one,),) = sx.plot(BALL, red, width=300).views
    assert one.values is not None and one.values.shape == (len(Z), 3)
    assert [len(row) for row in sx.plot(BALL, 41.3 * red, width=300).views] == [3]


def test_a_scan_is_shown_in_its_own_colours(tmp_path: Path) -> None:
    colors = np.tile(np.array([200.0, 40.0, 20.0]), (len(Z), 1))
    maps = dict(zip(("red", "green", "blue"), colors.T, strict=True))
    scan = sx.Surface(BALL.mesh, scalars=maps)
    ((own,),) = sx.plot(scan, width=300).views
    assert own.values is not None and np.allclose(own.values, colors / 255.0)
    pixels = sx.plot(scan, width=300).figure.pixels.astype(float)
    covered = (pixels < 250).any(axis=2)
    assert (pixels[covered][:, 0] > 2 * pixels[covered][:, 1]).mean() > 0.9
    (field,) = sx.view(scan).scene.surfaces[0].fields
    assert (
        field.labels is not None and not field.legend and np.allclose(field.labels.colors, colors[0] / 255.0, atol=0.02)
    )
    # one of its maps, where it is asked for
    assert sx.plot(scan, "red", width=300).views[0][0].is_scalar


@pytest.mark.parametrize(("count", "rows"), [(1, [1]), (2, [2]), (3, [3]), (4, [2, 2]), (5, [3, 2]), (8, [3, 3, 2])])
def test_maps_seen_from_one_side_stand_three_abreast(count: int, rows: list[int]) -> None:
    """One below the other eight of them were a picture ten times as high as wide."""
    picture = sx.plot(BALL, {f"map {k}": (k + 1) * Z for k in range(count)}, width=300)
    assert [len(row) for row in picture.views] == rows


def test_a_view_goes_to_a_page_or_a_picture(tmp_path: Path) -> None:
    for name in ("ball.html", "ball.png", "ball.SVG"):
        check_view_target(tmp_path / name)
    with pytest.raises(ValueError, match=r"ball\.gif has an unknown format, choose one of \.html, \.png"):
        check_view_target(tmp_path / "ball.gif")
