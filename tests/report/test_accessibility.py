"""What axe-core finds in our pages: nothing, wide or on a telephone, light or dark, still or turning."""

from __future__ import annotations

import importlib.util
import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from browser import PROGRAM, Browser, browser
from turning_page import turning_page

import surfexp as sx
from surfexp.report.overview import write_overview

RULES = importlib.util.find_spec("axe_core_python")
pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="needs chromium"),
    pytest.mark.skipif(RULES is None, reason="pip install axe-core-python"),
]
FOUND = "axe.run().then(({ violations }) => JSON.stringify(violations.map(({ id, nodes }) => [id, nodes[0].html])))"
WINDOWS = [(1200, False), (1200, True), (390, False), (390, True)]


@pytest.fixture(scope="module")
def one_browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as running:
        yield running


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return turning_page(tmp_path_factory.mktemp("page"))


def violations(tab: Browser) -> list[list[str]]:
    assert RULES is not None and RULES.submodule_search_locations
    tab.run((Path(RULES.submodule_search_locations[0]) / "axe.min.js").read_text(encoding="utf-8") + ";0")
    return list(json.loads(tab.run(FOUND)))


@pytest.mark.parametrize(("width", "dark"), WINDOWS)
def test_a_report(one_browser: Browser, report: Path, width: int, dark: bool) -> None:
    one_browser.open(report, width, 900, dark)
    assert violations(one_browser) == []
    assert one_browser.run("document.documentElement.scrollWidth <= innerWidth")
    one_browser.run("turning[0].button.click()")
    one_browser.wait("turning[0].button.textContent === 'Still' && !turning[0].button.disabled")
    assert violations(one_browser) == []


@pytest.mark.parametrize(("width", "dark"), WINDOWS)
def test_the_overview(one_browser: Browser, report: Path, width: int, dark: bool) -> None:
    write_overview(report.parent.parent)
    one_browser.open(report.parent.parent / "index.html", width, 900, dark)
    assert violations(one_browser) == []


@pytest.mark.parametrize(("width", "dark"), WINDOWS)
def test_a_view(one_browser: Browser, tmp_path: Path, width: int, dark: bool) -> None:
    ball = sx.shape("icosphere", levels=2)
    height = ball.mesh.vertices[:, 2]
    page = tmp_path / "view.html"
    sx.view(ball, {"height": height, "side": (height > 0).astype(int)}, title="a ball").save(page)
    one_browser.open(page, width, 900, dark)
    one_browser.wait("turning[0].panels.length === 2 && !waiting.size && !moving.size && !turning[0].button.disabled")
    assert violations(one_browser) == []
    assert one_browser.run("document.documentElement.scrollWidth <= innerWidth")
    for _ in range(20):
        press(one_browser, "Tab")
        if one_browser.run("document.activeElement.textContent") == "left":
            break
    press(one_browser, "Enter")
    assert one_browser.run("[turning[0].view.azimuth, turning[0].view.elevation].join()") == "180,0"


def press(tab: Browser, key: str) -> None:
    """Press a key as a person does who has no mouse."""
    text = {"text": "\r"} if key == "Enter" else {}
    code = {"Tab": 9, "Enter": 13}[key]
    for kind in ("keyDown", "keyUp"):
        tab.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, **text)


def test_a_page_with_a_fault_is_seen(one_browser: Browser, report: Path, tmp_path: Path) -> None:
    text = report.read_text(encoding="utf-8").replace("<main>", "").replace("</main>", "")
    (tmp_path / "report.html").write_text(text, encoding="utf-8")
    one_browser.open(tmp_path / "report.html")
    assert "landmark-one-main" in {rule for rule, _ in violations(one_browser)}
