"""Surfaces that turn, in a browser that is driven as a person would: what is shown is what was stored."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import PROGRAM, Browser, browser
from turning_page import STILL, results_of, torus, turning_page

from surfexp.figures.camera import VIEWS, view_axes
from surfexp.figures.encode import encode_png
from surfexp.figures.labelling import Labelling
from surfexp.viewer.page import viewer_page
from surfexp.viewer.scene import Drawn, Field, Scene, Step

pytestmark = pytest.mark.skipif(PROGRAM is None, reason="needs chromium")
EVIL = "</script></figure><img src=x onerror=\"document.title='run'\"><script>document.title='run'</script>"
MESH = torus(120, 72)
MADE = results_of(MESH, EVIL)
CAMERAS = "turning.map((figure) => figure.panels.map(({ camera }) => [...camera.quaternion.toArray(), camera.left, camera.top]))"
BOX = "({ left, top, width, height }) => [left, top, width, height]"
TOLD = "turning[0].panels.map(({ told }) => ({ ...told.dataset, text: told.textContent }))"
SHOWN = "[...document.querySelectorAll({!r})].map((one) => one.getClientRects().length > 0)"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return turning_page(tmp_path_factory.mktemp("page"), MADE)


@pytest.fixture(scope="module")
def one_browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as running:
        yield running


@pytest.fixture
def tab(one_browser: Browser, page: Path) -> Browser:
    one_browser.open(page)
    return one_browser


def turn(tab: Browser, number: int = 0) -> None:
    """Press the button of a figure and wait until its surfaces rest."""
    click(tab, f"turning[{number}].button")
    tab.wait(f"turning[{number}].button.textContent === 'Still' && !turning[{number}].button.disabled")
    tab.wait("!waiting.size && !moving.size")


def click(tab: Browser, element: str) -> None:
    left, top, width, height = box(tab, element)
    for kind in ("mousePressed", "mouseReleased"):
        tab.point(left + width / 2, top + height / 2, kind, button="left", clickCount=1)


def box(tab: Browser, element: str) -> tuple[float, float, float, float]:
    """Left, top, width and height of an element, which is scrolled into the window."""
    tab.run(f"{element}.scrollIntoView({{ block: 'center', behavior: 'instant' }})")
    left, top, width, height = tab.run(f"(({BOX})({element}.getBoundingClientRect()))")
    return left, top, width, height


def errors(tab: Browser) -> list[str]:
    """What the page complained of; a driver's word on its speed aside."""
    return [said for said in tab.complaints if "GL Driver Message" not in said]


def test_the_still_picture_is_there_first_and_a_button_turns_it_and_back(tab: Browser) -> None:
    assert tab.run(SHOWN.format("figure img")) == [True, True] and tab.run(SHOWN.format(".panel canvas")) == []
    turn(tab)
    assert tab.run(SHOWN.format("figure img")) == [False, True]
    names = tab.run("turning[0].panels.map(({ field }) => field.name)")
    assert names == ["image", "result", "residual"]
    drawn = """turning[0].panels.map(({ canvas: c }) => { const { data } = c.getContext('2d').getImageData(0, 0, c.width,
      c.height); return data.filter((value, i) => i % 4 === 3 && value).length / (c.width * c.height); })"""
    assert all(0.05 < share < 0.95 for share in tab.run(drawn))
    assert tab.run("renderer !== null && THREE.REVISION === undefined") and errors(tab) == []
    click(tab, "turning[0].button")
    assert tab.run(SHOWN.format("figure img")) == [True, True] and tab.run("turning[0].panels.length") == 0


def test_a_drag_turns_all_panels_of_the_comparison_alike(tab: Browser) -> None:
    turn(tab, 0)
    turn(tab, 1)
    before = np.array(tab.run(CAMERAS))
    left, top, width, height = box(tab, "turning[0].panels[1].canvas")
    middle = (left + width / 2, top + height / 2)
    tab.drag(middle, (middle[0] + 60, middle[1] + 25))
    tab.wait("!waiting.size && !moving.size")
    after = np.array(tab.run(CAMERAS))
    assert np.ptp(before.reshape(-1, 6), axis=0).max() < 1e-12 and np.ptp(after.reshape(-1, 6), axis=0).max() < 1e-12
    assert np.abs(after - before)[..., :4].max() > 0.1 and (after == before)[..., 4:].all()
    assert tab.run("turning.map(({ view }) => [view.azimuth, view.elevation])") == [[-80.0 - 30.0, 12.0 + 12.5]] * 2
    tab.call("Input.dispatchKeyEvent", type="keyDown", key="t", text="t")
    top_view = tab.run("turning.map(({ view }) => [view.azimuth, view.elevation])")
    assert top_view == [list(VIEWS["top"])] * 2
    click(tab, "turning[1].views.querySelector('button')")
    tab.wait("!waiting.size && !moving.size")
    assert np.array_equal(np.array(tab.run(CAMERAS)), before) and errors(tab) == []


def test_every_value_in_the_page_is_within_half_a_step_of_the_stored_one(tab: Browser) -> None:
    stored = {"image": MADE["image"].values, "result": MADE["solver"].values}
    stored["residual"] = stored["image"] - stored["result"]
    reading = """(async () => { const found = {}; for (const { name, steps: [step] } of
      turning[0].scene.surfaces[0].fields) { const at = await numbersOf(step.values);
      found[name] = [...Array(at.rows).keys()].map((row) => at(row)); } return found; })()"""
    for name, values in tab.run(reading).items():
        assert np.abs(np.array(values) - stored[name]).max() <= 0.5 * np.ptp(stored[name]) / 65535 * (1 + 1e-9)
    (surface,) = tab.run(
        "Promise.all(turning[0].scene.surfaces.map(({ faces }) => codesOf(faces).then((f) => [...f])))"
    )
    assert (np.array(surface).reshape(-1, 3) == MESH.faces).all()


def seen_at(x: float, y: float, width: float, height: float) -> int:
    """The corner nearest to where a line of sight first meets the torus, by way of its faces on the screen; -1: none."""
    low, high = MESH.vertices.min(axis=0), MESH.vertices.max(axis=0)
    centred = MESH.vertices - 0.5 * (low + high)
    unit = 1.04 * np.linalg.norm(centred, axis=1).max() / (0.5 * min(width, height))  # length of a pixel
    seen = (view_axes(-80.0, 12.0) @ centred.T).T  # right, up, toward the eye
    at = np.array([(x - width / 2) * unit, (height / 2 - y) * unit])
    a, b, c = (seen[MESH.faces[:, k]] for k in range(3))
    frames = np.stack([b - a, c - a], axis=2)[:, :2]
    shares = np.linalg.solve(frames, (at - a[:, :2])[:, :, None])[:, :, 0]
    met = np.flatnonzero((shares >= 0.0).all(axis=1) & (shares.sum(axis=1) <= 1.0))
    if not len(met):
        return -1
    points = a + shares[:, :1] * (b - a) + shares[:, 1:] * (c - a)
    first = met[np.argmax(points[met, 2])]
    corners = MESH.faces[first]
    return int(corners[np.argmin(np.linalg.norm(seen[corners] - points[first], axis=1))])


def test_the_pointer_tells_the_nearest_vertex_and_its_value_in_every_panel(tab: Browser) -> None:
    turn(tab)
    left, top, width, height = box(tab, "turning[0].panels[0].canvas")
    image, result = MADE["image"].values, MADE["solver"].values
    found = []
    for x, y in np.round(np.random.default_rng(0).uniform((0.1, 0.2), (0.9, 0.8), (12, 2)) * (width, height)):
        tab.point(left + x, top + y)
        tab.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        told = tab.run(TOLD)
        found.append(vertex := seen_at(x, y, width, height))
        assert [int(one["vertex"]) for one in told] == [vertex] * 3
        for one, values in zip(told, (image, result, image - result), strict=True):
            if vertex < 0:
                assert not one["value"] and not one["text"].strip()
                continue
            assert abs(float(one["value"]) - values[vertex]) <= 0.5 * np.ptp(values) / 65535 * (1 + 1e-9)
            assert one["text"].startswith(f"vertex {vertex}: ") and one["text"].endswith(" mm")
    assert len(set(found)) > 5 and -1 in found


def test_another_field_is_chosen_and_has_its_own_bar(tab: Browser) -> None:
    turn(tab)
    said = "[turning[0].panels[0].label.textContent, turning[0].panels[0].ticks.textContent]"
    before = tab.run(said)
    tab.run("(({ fields }) => { fields.value = 2; fields.dispatchEvent(new Event('change')); })(turning[0].panels[0])")
    tab.wait(f"{said}[0].startsWith('residual (mm)')")
    assert tab.run(said)[1] == "−0.2500.25" and before[0].startswith(f"{EVIL} (mm)\n")


def test_no_text_of_an_experiment_runs(tab: Browser) -> None:
    turn(tab)
    assert (
        tab.run("document.title") == "A sweep"
        and tab.run("document.querySelectorAll('img[onerror], img[src=x]').length") == 0
    )
    assert tab.run("turning[0].panels[0].label.textContent").startswith(f"{EVIL} (mm)\n")
    assert errors(tab) == []  # among them what its policy stops


def test_on_paper_there_is_the_still_picture(tab: Browser) -> None:
    turn(tab)
    tab.call("Emulation.setEmulatedMedia", media="print")
    assert tab.run(SHOWN.format("figure img")) == [True, True]
    assert not any(tab.run(SHOWN.format(".panel canvas, .tools")))
    assert len(tab.call("Page.printToPDF")["data"]) > 1000


def test_without_scripts_the_page_is_whole(tab: Browser, page: Path) -> None:
    tab.call("Emulation.setScriptExecutionDisabled", value=True)
    try:
        tab.open(page)
        assert (
            tab.run(SHOWN.format("figure img")) == [True, True]
            and tab.run("document.querySelectorAll('button').length") == 0
        )
    finally:
        tab.call("Emulation.setScriptExecutionDisabled", value=False)


def test_a_picture_alone_turns_too(tab: Browser, tmp_path: Path) -> None:
    field = Field(EVIL, (Step(MESH.vertices[:, 2]),))
    scene = Scene([Drawn(EVIL, MESH, [field, Field("surface")])], [(0, 0), (0, 1)])
    file = tmp_path / "picture.html"
    file.write_text(viewer_page(scene, title=EVIL, caption=EVIL, still=encode_png(STILL.pixels)))
    tab.open(file)
    assert tab.run("document.querySelector('img').naturalWidth") == STILL.pixels.shape[1]
    turn(tab)
    assert tab.run("turning[0].panels.map(({ fields }) => fields.selectedOptions[0].textContent)") == [EVIL, "surface"]
    assert tab.run("document.title") == EVIL and errors(tab) == []


def test_without_graphics_the_button_says_why(page: Path, tmp_path: Path) -> None:
    with browser(tmp_path, "--disable-3d-apis") as without:
        without.open(page)
        click(without, "turning[0].button")
        without.wait("turning[0].note.textContent")
        assert without.run("turning[0].note.textContent") == "Stays still: this browser has no WebGL 2."
        assert without.run(SHOWN.format("figure img")) == [True, True]


def test_keys_zoom_and_a_slow_machine_turns_fewer_faces(tab: Browser) -> None:
    turn(tab)
    counts: dict[str, Any] = {}
    for cost in (0, 1000):
        tab.run(f"turning[0].cost = {cost}; turning[0].panels[0].draw(false)")
        counts[f"moving {cost}"] = tab.run("turning[0].panels[0].mesh.geometry.index.count")
        tab.run("turning[0].panels[0].draw(true)")
        counts[f"resting {cost}"] = tab.run("turning[0].panels[0].mesh.geometry.index.count")
    whole = 3 * len(MESH.faces)
    assert counts["moving 0"] == counts["resting 0"] == counts["resting 1000"] == whole > counts["moving 1000"] > 0
    tab.run("turning[0].panels[0].canvas.focus()")
    tab.call("Input.dispatchKeyEvent", type="keyDown", key="+", text="+")
    assert tab.run("turning[0].view.zoom") == pytest.approx(1.2)
    larger = "[...turning[0].views.querySelectorAll('button')].find((one) => one.textContent === 'larger').click()"
    tab.run(larger)
    assert tab.run("turning[0].view.zoom") == pytest.approx(1.44)


def test_enter_tells_the_value_in_the_middle_of_the_canvas(tab: Browser) -> None:
    turn(tab)
    _, _, width, height = box(tab, "turning[0].panels[0].canvas")
    tab.run("turning[0].panels[0].canvas.focus()")
    tab.call("Input.dispatchKeyEvent", type="keyDown", key="Enter")
    assert [int(one["vertex"]) for one in tab.run(TOLD)] == [seen_at(width / 2, height / 2, width, height)] * 3


def test_numbers_have_the_digits_that_tell_neighbours_apart(tab: Browser) -> None:
    for value, step, text in (
        (1234.5, 0.333, "1234.5"),
        (1000.1, 0.008, "1000.1"),
        (2.5, 0.03, "2.5"),
        (0.0, 1.0, "0"),
        (1e-30, 1e-32, "1e−30"),
        (2.5e-30, 1e-32, "2.5e−30"),
        (-1.25e12, 1e9, "−1.25e12"),
    ):
        assert tab.run(f"digits({value!r}, {step!r})") == text
    for value, text in ((163841.0, "163841"), (2.345678, "2.3457"), (-0.00012345, "−0.00012345"), (1e-30, "1e−30")):
        assert tab.run(f"significant({value!r}, 5)") == text


def test_of_two_requests_the_later_one_colours_the_surface(tab: Browser) -> None:
    """The first waits for its numbers until the second is drawn."""
    turn(tab)
    tab.run("""(async () => {
      const [panel] = turning[0].panels, read = numbersOf;
      let free, called;
      const held = new Promise((done) => (free = done)), asked = new Promise((done) => (called = done));
      numbersOf = async (described) => (called(), await held, read(described));
      panel.fields.value = 1;
      const first = panel.show(0);
      await asked;
      numbersOf = read;
      panel.fields.value = 0;
      await panel.show(0);
      const shade = () => [...panel.mesh.geometry.attributes.shade.array];
      const before = shade();
      free();
      await first;
      window.kept = shade().every((one, k) => one === before[k]) && panel.field.name === "image";
    })()""")
    assert tab.run("window.kept") is True


def test_labels_over_a_map_wait_for_their_turn(tab: Browser) -> None:
    """Lines of labels that come late leave no surface without colours over the map that was chosen meanwhile."""
    turn(tab)
    tab.run("""(async () => {
      const [panel] = turning[0].panels, { described } = panel, read = lineMesh;
      described.fields.push({ ...described.fields[0], name: "labels", labels: ["a"], limits: null,
        steps: [{ ...described.fields[0].steps[0], lines: [1] }] });
      panel.fields.append(new Option("labels", described.fields.length - 1));
      let free;
      lineMesh = () => new Promise((done) => (free = () => done(new THREE.Mesh())));
      panel.fields.value = described.fields.length - 1;
      const first = panel.show(0);
      lineMesh = read;
      panel.fields.value = 0;
      await panel.show(0);
      free();
      await first;
      window.bare = panel.flat === undefined && panel.mesh.visible;
    })()""")
    assert tab.run("window.bare") is True


def test_each_of_many_labels_has_its_own_colour(tab: Browser, tmp_path: Path) -> None:
    """Label 2000 is red, all others are black: a texture has 1024 colours a row."""
    colors = np.zeros((3000, 3))
    colors[2000, 0] = 1.0
    labels = Labelling(np.full(len(MESH.vertices), 2000), tuple(map(str, range(3000))), colors)
    field = Field("labels", (Step(labels.values),), labels=labels)
    (tmp_path / "labels.html").write_text(viewer_page(Scene([Drawn("torus", MESH, [field])], [(0, 0)])))
    tab.open(tmp_path / "labels.html")
    tab.wait("turning[0].panels.length === 1 && !waiting.size && !moving.size && !turning[0].button.disabled")
    red, green = tab.run("""(() => { const { canvas: c } = turning[0].panels[0];
      const { data } = c.getContext('2d').getImageData(0, 0, c.width, c.height);
      return [0, 1].map((channel) => data.filter((value, i) => i % 4 === channel).reduce((a, b) => Math.max(a, b))); })()""")
    assert red > 100 and green < 20
    assert tab.run("turning[0].panels[0].names.children.length") == 201 and errors(tab) == []
