"""A path as a page with a slider: what the slider shows is the map at its weight, what is said of it is what is known."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.viewer.curve import even_ticks, tens

sys.path.insert(0, str(Path(__file__).parents[1] / "report"))
from browser import PROGRAM, Browser, browser

BALL = sx.shape("icosphere", levels=4)
X, Y, Z = BALL.mesh.vertices.T
NOISY = 2.0 * np.sign(Z) + X + np.random.default_rng(0).standard_normal(len(X))
NOISY[Z < -0.95] = np.nan
PATH = sx.denoise_path(BALL, NOISY, noise=1.0, weights=(0.1, 10.0))
RISK = PATH.risk()
SHOWN = "turning[0].panels[0]"
READ = f"[...Array({len(X)}).keys()].map((row) => {SHOWN}.values(row))"
SLIDER = "turning[0].curve.slider"
PART = np.isfinite(NOISY)

driven = pytest.mark.skipif(PROGRAM is None, reason="needs chromium")


@pytest.fixture(scope="module")
def tab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    folder = tmp_path_factory.mktemp("page")
    PATH.view(BALL, title="A <path>").save(folder / "path.html")
    with browser(folder / "profile") as running:
        running.open(folder / "path.html")
        running.wait("turning[0].curve && !waiting.size && !moving.size && !turning[0].button.disabled")
        yield running


def errors(tab: Browser) -> list[str]:
    """What the page complained of; a driver's word on its speed aside."""
    return [said for said in tab.complaints if "GL Driver Message" not in said]


def stand(tab: Browser, at: int) -> None:
    """Move the slider as a person does, and wait for the colours."""
    tab.run(f"{SLIDER}.value = {at}; {SLIDER}.dispatchEvent(new Event('input'))")
    tab.wait("!waiting.size && !moving.size")
    tab.run("new Promise((done) => setTimeout(done, 100))")


@driven
def test_the_slider_first_stands_at_the_least(tab: Browser) -> None:
    assert tab.run(f"[{SLIDER}.value, {SLIDER}.max]") == [str(RISK.best), str(len(RISK.weights) - 1)]
    said = tab.run("turning[0].curve.said.textContent")
    assert said.startswith(f"weight {RISK.weight:.3g}\nRelative gap ") and said.endswith("the noise: the least.")
    assert tab.run(f"{SHOWN}.sliding.hidden") and errors(tab) == []


@driven
@pytest.mark.parametrize("at", [0, 7, 18, 33, 40])
def test_at_each_weight_the_page_shows_the_map_of_that_weight(tab: Browser, at: int) -> None:
    stand(tab, at)
    expected = PATH.at(float(RISK.weights[at]))
    shown = np.array(tab.run(READ), dtype=float)
    seen = np.isfinite(expected.values)
    np.testing.assert_array_equal(np.isfinite(shown), seen)
    assert np.abs(shown - expected.values)[seen].max() < np.ptp(NOISY[PART]) / 65535
    said = tab.run("turning[0].curve.said.textContent")
    assert f"gap {expected.certificate['relative_gap']:.1e}".replace("e-0", "e-") in said
    assert f"{RISK.risks[at]:.3f} ± {RISK.errors[at]:.3f} of the variance" in said
    assert tab.run(f"{SLIDER}.getAttribute('aria-valuetext')").startswith(f"weight {RISK.weights[at]:.3g}. Relative")


@driven
def test_keys_and_the_chart_move_the_slider(tab: Browser) -> None:
    stand(tab, 10)
    tab.run(f"{SLIDER}.focus()")
    tab.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowRight", code="ArrowRight", windowsVirtualKeyCode=39)
    tab.wait(f"{SLIDER}.value === '11'")
    left, top, width, height = tab.run(
        "(({ left, top, width, height }) => [left, top, width, height])(turning[0].curve.svg.getBoundingClientRect())"
    )
    place = (left + width * tab.run("turning[0].curve.x(turning[0].curve.places[30])") / 480, top + height / 2)
    tab.point(*place, "mousePressed", button="left", buttons=1, clickCount=1)
    tab.point(*place, "mouseReleased", button="left", clickCount=1)
    tab.wait(f"{SLIDER}.value === '30'")
    tab.run("turning[0].curve.button.click()")
    assert tab.run(f"{SLIDER}.value") == str(RISK.best) and errors(tab) == []


@driven
def test_the_map_before_is_there_to_compare_and_the_slider_keeps_its_place(tab: Browser) -> None:
    stand(tab, 5)
    choose = f"(({{ fields }}) => {{ fields.value = VALUE; fields.dispatchEvent(new Event('change')); }})({SHOWN})"
    tab.run(choose.replace("VALUE", "1"))
    tab.wait(f"Math.abs({SHOWN}.values({int(np.flatnonzero(PART)[3])}) - {NOISY[PART][3]}) < 1e-3")
    tab.run(choose.replace("VALUE", "0"))
    value = PATH.at(float(RISK.weights[5])).values[PART][3]
    tab.wait(f"Math.abs({SHOWN}.values({int(np.flatnonzero(PART)[3])}) - {value}) < 1e-3")


@driven
def test_nothing_of_the_chart_is_cut_off_on_a_small_screen(tab: Browser, tmp_path: Path) -> None:
    file = tmp_path / "path.html"
    PATH.view(BALL).save(file)
    tab.open(file, width=390)
    tab.wait("turning[0].curve && !turning[0].button.disabled")
    outside = """(({ left, right, top, bottom }) => [...turning[0].curve.svg.querySelectorAll('text')].filter((text) => {
      const box = text.getBoundingClientRect();
      return box.left < left - 1 || box.right > right + 1 || box.top < top - 1 || box.bottom > bottom + 1;
    }).map((text) => text.textContent))(turning[0].curve.svg.getBoundingClientRect())"""
    assert tab.run(outside) == [] and tab.run("document.documentElement.scrollWidth") <= 390


def test_a_page_of_ten_thousand_vertices_takes_35_kb_for_each_solve() -> None:
    """2 MB for 40 solves, with the 0.6 MB of the viewer."""
    fine = sx.shape("icosphere", levels=5)
    values = np.sign(fine.mesh.vertices[:, 2]) + 0.5 * np.random.default_rng(1).standard_normal(10242)
    path = sx.denoise_path(fine, values, noise=0.5, tolerance=3e-3)
    assert len(path.weights) > 15
    assert len(path.view(fine).html()) < 700_000 + 35_000 * len(path.weights)


def test_stops_are_places_between_the_solved_weights() -> None:
    assert PATH.place(float(PATH.weights[0])) == 0.0
    assert PATH.place(float(PATH.weights[-1])) == pytest.approx(len(PATH.weights) - 1)
    maps = [PATH.at(float(weight)).values[PART] for weight in PATH.weights]
    place = PATH.place(0.77)
    first, share = int(place), place % 1.0
    mixed = (1.0 - share) * maps[first] + share * maps[first + 1]
    np.testing.assert_allclose(mixed, PATH.at(0.77).values[PART], atol=1e-12)


def test_two_hemispheres_have_one_slider(working_folder: Path) -> None:
    left, right = (sx.shape("icosphere", levels=3) for _ in range(2))
    for side, one in (("lh", left), ("rh", right)):
        sx.write(f"{side}.ball.surf.gii", one)
    brain = sx.read(left="lh.ball.surf.gii", right="rh.ball.surf.gii")
    vertices = brain.mesh.vertices
    values = np.sign(vertices[:, 2]) + 0.5 * np.random.default_rng(2).standard_normal(len(vertices))
    seen = sx.view(brain, sx.denoise_path(brain, values, weights=(0.3, 3.0), tolerance=1e-2))
    assert len(seen.scene.surfaces) == 2 and seen.scene.curve is not None
    assert all(len(one.fields[0].stops) == len(seen.scene.curve.places) for one in seen.scene.surfaces)


def test_two_solves_in_the_unit_interval_are_no_colours() -> None:
    values = 0.5 + 0.1 * np.sign(Z) + 0.02 * np.random.default_rng(3).standard_normal(len(Z))
    path = sx.denoise_path(BALL, values, noise=0.02, weights=(0.9, 1.0), tolerance=1e-2)
    assert len(path.weights) == 2
    (drawn,) = path.view(BALL).scene.surfaces
    assert len(drawn.fields[0].steps) == 2 and drawn.fields[0].labels is None


def test_stills_show_three_weights_and_the_map_before(tmp_path: Path) -> None:
    picture = PATH.plot(BALL, width=800)
    names = [one.title for one in picture.views[0]]
    assert len(picture.views) == 1 and names[3] == "before" and names[1].startswith(f"weight {RISK.weight:.3g}, risk")
    values = picture.views[0][1].values
    assert values is not None
    np.testing.assert_allclose(values[PART], PATH.at(RISK.weight).values[PART])
    PATH.view(BALL).save(tmp_path / "path.png")
    assert (tmp_path / "path.png").stat().st_size > 5000


def test_what_cannot_be_shown_is_refused() -> None:
    with pytest.raises(ValueError, match="without contours"):
        sx.view(BALL, PATH, contours=[0.0])
    with pytest.raises(ValueError, match="2562"):
        PATH.view(sx.shape("icosphere", levels=3))
    colours = sx.denoise_path(BALL, np.column_stack([X, Y, Z]), noise=0.1, weights=(0.9, 1.0), tolerance=0.1)
    with pytest.raises(ValueError, match="one channel"):
        colours.view(BALL)


def test_ticks_lie_within_their_axis() -> None:
    assert tens(0.03, 30.0) == [0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0] and tens(0.4, 0.9) == []
    for low, high in ((0.0, 1.1), (-0.04, 0.3), (0.0, 37.0), (-5.0, 2e-3)):
        ticks = even_ticks(low, high)
        assert 2 <= len(ticks) <= 7 and low <= ticks[0] and ticks[-1] <= high
