"""What of stored results goes into a page whose surfaces turn: every number within half a step, within a budget."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from turning_page import results_of, torus, turning_page, turning_plan

import surfexp.figures.shading as shading
from surfexp.figures.colormap import ColorScale
from surfexp.figures.labelling import Labelling
from surfexp.lab.composition.launch import launch
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.report.turning import scene as scene_module
from surfexp.report.turning.fields import MODES, feature_field, image_fields, mode_field
from surfexp.report.turning.scene import scene_of
from surfexp.report.turning.turning import Turning
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution
from surfexp.viewer import page as page_module
from surfexp.viewer.page import SCRIPTS
from surfexp.viewer.payload import Payload
from surfexp.viewer.quantised import packed, quantised, unpacked
from surfexp.viewer.scene import Drawn, Field, Scene, Step

ASSETS = Path(page_module.__file__).parent / "assets"
VIEWER = Path(__file__).resolve().parents[2] / "viewer"
FLOATS = st.floats(-1e150, 1e150) | st.floats(-1.0, 1.0) | st.sampled_from([np.nan, np.inf, -np.inf])
SHAPES = st.tuples(st.integers(0, 6), st.integers(1, 4))
TABLES = arrays.arrays(np.float64, SHAPES, elements=FLOATS)
MESH = torus(20, 12)


@given(TABLES)
def test_every_number_is_within_half_a_step_and_gaps_stay_gaps(values: np.ndarray) -> None:
    found, finite = quantised(values), np.isfinite(values)
    again = found.values()
    assert found.gaps == (not finite.all()) and (np.isfinite(again) == finite).all()
    for column, low, step, inside, back in zip(values.T, found.low, found.step, finite.T, again.T, strict=True):
        kept = column[inside]
        extent = np.ptp(kept) if kept.size else 0.0
        assert step == extent / (65534 if found.gaps else 65535)
        rounding = 4.0 * np.spacing(np.abs(kept).max(initial=0.0))
        assert (np.abs(back[inside] - kept) <= 0.5 * step + rounding).all()
        assert not kept.size or low == kept.min()


def test_a_span_beyond_all_numbers_is_refused() -> None:
    with pytest.raises(ValueError, match="span more"):
        quantised(np.array([-1.7e308, 1.7e308]))


@given(st.sampled_from([np.uint8, np.uint16, np.uint32]).flatmap(lambda t: arrays.arrays(t, SHAPES)))
def test_codes_are_unpacked_as_they_were_packed(codes: np.ndarray) -> None:
    assert (unpacked(packed(codes), codes.dtype, codes.shape[1]) == codes).all()


def read(payload: Payload, described: dict[str, Any]) -> np.ndarray:
    """An array as its description and the payload give it back."""
    codes = unpacked(payload.arrays[described["array"]], np.dtype(described["type"]), described["columns"])
    if "step" not in described:
        return codes
    values = np.array(described["low"]) + np.array(described["step"]) * codes
    return np.where(described["gaps"] & (codes == 65535), np.nan, values)


@pytest.mark.parametrize("count", [12, 65535, 65536, 70000])
def test_faces_are_exact_and_positions_within_half_a_step(count: int) -> None:
    vertices = np.random.default_rng(0).normal(size=(count, 3)) * (1.0, 100.0, 1e-3)
    mesh = TriangleMesh(vertices, np.random.default_rng(1).integers(0, count, (500, 3)))
    payload = Payload()
    described = payload.add(Scene([Drawn("any", mesh, [])], []))["surfaces"][0]
    assert (read(payload, described["faces"]) == mesh.faces).all()
    error = np.abs(read(payload, described["positions"]) - vertices).max(axis=0)
    assert (error <= 0.5 * np.ptp(vertices, axis=0) / 65535 * (1 + 1e-9)).all() and error.max() > 0.0


def test_the_last_corner_of_16_bits_names_no_vertex() -> None:
    """WebGL 2 takes it as the end of a strip: the face with it would be lost, and all after it joined otherwise."""
    for count, kind in ((65535, "uint16"), (65536, "uint32")):
        mesh = TriangleMesh(np.zeros((count, 3)), np.array([[0, 1, count - 1]]))
        assert Payload().add(Scene([Drawn("any", mesh, [])], []))["surfaces"][0]["faces"]["type"] == kind


def test_one_value_far_from_all_others_leaves_them_as_they_are() -> None:
    values = np.random.default_rng(0).uniform(1.0, 4.0, len(MESH.vertices))
    for far, exact in ((5.0, False), (1e6, True), (3.4e38, True)):
        values[7], values[9] = far, np.nan
        payload = Payload()
        fields = [Field("thickness", (Step(values),), ColorScale("thickness"))]
        described = payload.add(Scene([Drawn("any", MESH, fields)], [(0, 0)]))["surfaces"][0]["fields"][0]
        found = described["steps"][0]["values"]
        assert found.get("exact", False) == exact and 3.0 < described["limits"][1] < 4.1
        if exact:
            codes = unpacked(payload.arrays[found["array"]], np.dtype(np.uint32), 2)
            assert np.array_equal(np.ascontiguousarray(codes).view(np.float64).ravel(), values, equal_nan=True)


def test_more_labels_than_codes_are_refused_with_the_way_out() -> None:
    names = tuple(map(str, range(65536)))
    labels = Labelling(np.zeros(len(MESH.vertices), np.int64), names, np.zeros((65536, 3)))
    with pytest.raises(ValueError, match="65536 labels, a page tells 65535 apart: give the numbers as floats"):
        Payload().add(Scene([Drawn("any", MESH, [Field("labels", (Step(labels.values),), labels=labels)])], [(0, 0)]))


def scenes(tmp_path: Path, made: dict[str, Any], **changes: Any) -> tuple[list[Scene], Turning, list[dict[str, Any]]]:
    plan = turning_plan(tmp_path, made, **changes)
    keys = [key for leaf in plan.leaves for key in leaf.figures]
    turning = Turning(tmp_path)
    found = [scene_of(plan.nodes, key, lambda kind, one: store.load(tmp_path, kind, one)) for key in keys]
    return [scene for scene in found if scene is not None], turning, [turning.of(plan.nodes, key) for key in keys]


def test_a_denoising_turns_with_its_image_result_and_residual(tmp_path: Path) -> None:
    made = results_of(MESH)
    (first, second), turning, described = scenes(tmp_path, made)
    assert [one.name for one in first.surfaces[0].fields] == ["image", "result", "residual"]
    assert first.panels == [(0, 0), (0, 1), (0, 2)] and first.view == (-80.0, 12.0)
    image, result, residual = (one.steps[0].values for one in second.surfaces[0].fields)
    assert (image == made["image"].values).all() and (result == 0.5 * made["solver"].values).all()
    assert (residual == image - result).all()
    surfaces = [one["scene"]["surfaces"][0] for one in described]
    # the comparison shows one surface and one image: they are there once
    assert surfaces[0]["positions"] == surfaces[1]["positions"]
    assert surfaces[0]["fields"][0]["steps"] == surfaces[1]["fields"][0]["steps"]
    # mesh, image, one result (the other is half of it: the same codes in other steps), two residuals, two colour maps
    assert len(turning.payload.arrays) == 2 + 1 + 1 + 2 + 2
    assert json.dumps(described, allow_nan=False)


def test_outside_the_mask_there_is_no_value(tmp_path: Path) -> None:
    made = results_of(MESH)
    inside = MESH.vertices[:, 2] > 0.0
    made["surface"] = replace(made["surface"], mask=inside)
    (scene, _), _, _ = scenes(tmp_path, made)
    for one in scene.surfaces[0].fields:
        assert (np.isnan(one.steps[0].values) == ~inside).all()


def test_what_does_not_fit_stays_still_and_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = turning_page(tmp_path, results_of(MESH)).read_text()
    size = sum(map(len, re.findall(r'id="array-\w+">([^<]+)<', whole)))
    assert whole.count('class="scene"') == 2 and "Stays still" not in whole.split("<script>")[0]
    for budget, turned in ((0, 0), (size - 1, 1), (size, 2)):
        monkeypatch.setattr("surfexp.report.turning.turning.Payload", lambda budget=budget: Payload(budget))
        page = turning_page(tmp_path, results_of(MESH)).read_text()
        body = page.split("<script>")[0]
        assert (page.count('class="scene"'), body.count("Stays still: ")) == (turned, 2 - turned)
        assert ("THREE" in page) == (turned > 0) and sum(
            map(len, re.findall(r'id="array-\w+">([^<]+)<', page))
        ) <= budget


def test_results_that_cannot_be_read_leave_the_still_picture(tmp_path: Path) -> None:
    made = results_of(MESH)
    page = turning_page(tmp_path, {"figure": made["figure"]}).read_text()  # all else is hollow
    assert page.count("its surfaces could not be read") == 2 and "<img" in page


def planned(experiment: str, plugin: str, made: dict[str, Any]) -> Scene:
    """The scene of the first figure of a plugin in an experiment, each stage of a kind with the same result."""
    plans: list[Plan] = []
    launch([f"experiment={experiment}"], plans.append)
    keys = [key for leaf in plans[0].leaves for key in leaf.figures if plans[0].nodes[key].plugin == plugin]
    scene = scene_of(plans[0].nodes, keys[0], lambda kind, one: made[kind])
    assert scene is not None
    return scene


def test_results_go_to_the_surface_that_they_were_made_on(working_folder: Path) -> None:
    moved = Solution(1.1 * MESH.vertices, 0.0)
    scene = planned("geometry_denoising", "geometry", {**results_of(MESH), "solver": moved})
    assert [(one.name, [field.name for field in one.fields]) for one in scene.surfaces] == [
        ("clean", ["surface"]),
        ("noisy", ["surface"]),
        ("result", ["surface"]),
    ]
    assert (scene.surfaces[2].mesh.vertices == moved.values).all() and scene.panels == [(0, 0), (1, 0), (2, 0)]
    feature = Feature(MESH.vertices[:, 0], "height")
    made = {**results_of(MESH), "feature": feature, "skeleton": reeb_graph(MESH, feature.values, np.zeros(1))}
    (surface,) = planned("flux_weights", "level_sets", made).surfaces
    lines = {one.name: len(one.steps[0].lines) for one in surface.fields}
    assert len(lines) == 8 and all((count > 0) == name.startswith("features ") for name, count in lines.items())


def test_more_surfaces_than_a_page_can_turn_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_module, "SURFACES", 0)
    plan = turning_plan(tmp_path, results_of(MESH))
    with pytest.raises(ValueError, match="1 surfaces are more than the 0"):
        scene_of(plan.nodes, plan.leaves[0].figures[0], lambda kind, one: None)


def test_modes_come_in_units_of_their_root_mean_square_with_nodal_lines() -> None:
    n = len(MESH.vertices)
    waves = np.stack([np.ones(n), *(MESH.vertices[:, k % 3] * (k + 1.0) for k in range(MODES + 5))], axis=1)
    vectors = waves / np.sqrt(MESH.vertex_areas @ waves**2)
    system = EigenSystem(np.arange(len(vectors.T), dtype=float), vectors, np.zeros(n), 0.0, True, area=MESH.area)
    field = mode_field(MESH, system)
    assert len(field.steps) == MODES and field.steps[3].name == "mode 3, λ = 3" and not field.steps[0].lines
    for step in field.steps:
        assert MESH.vertex_areas @ step.values**2 == pytest.approx(MESH.area)
    assert np.abs(field.steps[3].lines[0].points[:, 2]).max() < 1e-12  # mode 3 is z here


def test_a_feature_has_the_levels_and_the_graph_of_its_skeleton() -> None:
    feature = Feature(MESH.vertices[:, 0], "height", "mm")
    skeleton = reeb_graph(MESH, feature.values, np.array([-2.0, -1.0, 0.0, 1.0, 2.0]))
    (step,) = feature_field(MESH, feature, skeleton).steps
    levels, *graph = step.lines
    assert set(np.round(levels.points[:, 0], 12)) == {-2.0, -1.0, 0.0, 1.0, 2.0} and not levels.through
    assert all(one.through for one in graph) and (graph[0].segments == skeleton.arcs).all()
    assert not feature_field(MESH, feature, None).steps[0].lines


def test_a_segmentation_shows_its_regions_and_their_boundary() -> None:
    labels = (MESH.vertices[:, 0] > 0.1).astype(float)
    solution = Solution(labels, 0.0, segmentation=labels)
    image, regions = image_fields(MESH, Image(MESH.vertices[:, 0]), solution, "gray")
    assert (regions.name, image.name) == ("regions", "image") and image.steps[0].lines == regions.steps[0].lines
    ends = regions.steps[0].lines[0]
    lengths = np.linalg.norm(ends.points[ends.segments[:, 0]] - ends.points[ends.segments[:, 1]], axis=1)
    assert lengths.sum() == pytest.approx(2.0 * np.pi, rel=0.02)  # two circles around the tube


def test_colours_of_several_channels_are_fields_of_their_own() -> None:
    values = np.random.default_rng(0).uniform(size=(len(MESH.vertices), 3))
    names = [one.name for one in image_fields(MESH, Image(values), Solution(values, 0.0), "gray")]
    assert names[:2] == ["image, channel 1", "image, channel 2"] and len(names) == 9


def test_the_light_is_that_of_the_still_pictures() -> None:
    script = (ASSETS / "surface.js").read_text()
    for name in ("KEY_STRENGTH", "FILL_STRENGTH", "SKY", "GROUND", "WRAP", "RIM_DARKENING", "BACK_SHARE"):
        found = re.search(rf"\b{name} = ([\d.]+)", script)
        assert found and float(found[1]) == getattr(shading, name), name
    for name in ("KEY", "FILL", "BACK_TINT"):
        found = re.search(rf"\b{name} = vec3\(([^)]*)\)", script)
        assert found and tuple(map(float, found[1].split(","))) == getattr(shading, name), name


def test_the_library_is_the_pinned_one_and_names_no_address() -> None:
    bundle = (ASSETS / "three.bundle.js").read_text()
    pins = json.loads((VIEWER / "pins.json").read_text())
    assert bundle.startswith(f"// three.js {pins['three']['version']}, MIT licence")
    assert all(re.fullmatch(r"sha512-[\w+/]{86}==", pin["integrity"]) for pin in pins.values())
    assert "MIT License" in (ASSETS / "three.LICENSE.txt").read_text()
    # the name of a language, which nothing fetches
    assert set(re.findall(r"https?://[^\s\"'`]*", bundle)) == {"http://www.w3.org/1999/xhtml"}
    for script in SCRIPTS:
        text = (ASSETS / script).read_text()
        assert not re.search(r"</script|<!--|\beval\(|new Function", text), script
        assert "bundle" in script or not re.search(r"https?:|innerHTML|insertAdjacentHTML|document\.write", text), (
            script
        )
