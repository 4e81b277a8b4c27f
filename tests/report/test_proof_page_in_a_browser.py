"""Pages that prove themselves, in a browser: green as they are written, red after one number is changed."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import PROGRAM, Browser, browser

import surfexp as sx

pytestmark = [pytest.mark.skipif(PROGRAM is None, reason="needs chromium"), pytest.mark.slow]


@pytest.fixture(scope="module")
def tab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as running:
        yield running


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    sphere = sx.shape("icosphere", levels=2)
    values = sphere.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(162)
    body = sx.shape("ellipsoid", levels=2)
    made = {
        "rof": sx.proof_page(sx.denoise(sphere, values, method="rof")),
        "tgv": sx.proof_page(sx.denoise(sphere, values, method="tgv")),
        "modes": sx.proof_page(sx.eigenpairs(body, 12), body),
        "distance": sx.proof_page(sx.distance(body, body, 4), body, body),
    }
    return {name: page.html() for name, page in made.items()}


def verdict(tab: Browser, text: str, folder: Path) -> str:
    file = folder / "page.html"
    file.write_text(text, encoding="utf-8")
    tab.open(file)
    tab.wait("document.body.dataset.done")
    assert tab.complaints == []
    return str(tab.run("document.body.dataset.done"))


@pytest.mark.parametrize("name", ["rof", "tgv", "modes", "distance"])
def test_a_page_is_green_as_it_is_written(name: str, pages: dict[str, str], tab: Browser, tmp_path: Path) -> None:
    assert verdict(tab, pages[name], tmp_path) == "holds"
    assert tab.run("document.querySelectorAll('tr.fails').length") == 0
    assert tab.run("document.querySelectorAll('tr.holds').length") > 10
    assert "Each number was computed by this browser" in tab.run("document.getElementById('verdict').textContent")


def test_numbers_are_shown_with_their_exponents(tab: Browser, tmp_path: Path, pages: dict[str, str]) -> None:
    verdict(tab, pages["rof"], tmp_path)
    for number in (1.2e-10, -3.25e-20, 1.5e100, 0.1, 1e-7, 100.0, 2.0 / 3.0):
        assert float(tab.run(f"digits({number!r})")) == pytest.approx(number, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "array", "change"),
    [
        ("rof", "vertices", 1e-3),
        ("rof", "dual", 1e-3),
        ("tgv", "slopes", 1e-3),
        ("modes", "values", 1e-3),
        ("distance", "signs", -2),
    ],
)
def test_a_page_is_red_after_one_number_is_changed(
    name: str, array: str, change: float, pages: dict[str, str], tab: Browser, tmp_path: Path
) -> None:
    found = re.search(r'(id="claims"[^>]*>)(.*?)(</script>)', pages[name], re.DOTALL)
    assert found is not None
    claims: list[dict[str, Any]] = json.loads(found[2])
    held = claims[-1]["arrays"][array]
    numbers = np.frombuffer(base64.b64decode(held["data"]), held["type"]).copy()
    numbers[3] = -numbers[3] if change == -2 else numbers[3] + change
    held["data"] = base64.b64encode(numbers.tobytes()).decode()
    assert verdict(tab, pages[name].replace(found[2], json.dumps(claims)), tmp_path) == "fails"
    # the numbers themselves fail, not the bytes alone
    failed = tab.run("[...document.querySelectorAll('tr.fails th')].map((one) => one.textContent)")
    assert [what for what in failed if not what.startswith("SHA-256")]


def test_a_stated_number_without_its_claim_is_red(pages: dict[str, str], tab: Browser, tmp_path: Path) -> None:
    for forged in (
        re.sub(r'"relative_gap": [^,}]+', '"relative_gap": 1e-9', pages["rof"]),
        re.sub(r'"certified": \d+', '"certified": 11', pages["modes"]),
        re.sub(r'(id="claims"[^>]*>).*?(</script>)', r"\1[]\2", pages["modes"], flags=re.DOTALL),
    ):
        assert verdict(tab, forged, tmp_path) == "fails"
