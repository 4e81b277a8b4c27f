"""A report that is sent: alone in another folder it has its pictures, on paper and on a telephone too."""

from __future__ import annotations

import base64
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import PROGRAM, Browser, browser
from turning_page import turning_page

from surfexp.figures.encode import encode_png
from surfexp.report import stills

needs_browser = pytest.mark.skipif(PROGRAM is None, reason="needs chromium")
SEEN = "[...document.images].every((one) => one.complete && one.naturalWidth > 50) && document.images.length"


@pytest.fixture(scope="module")
def one_browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as running:
        yield running


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    page = turning_page(tmp_path_factory.mktemp("page"))
    return Path(shutil.copy(page, tmp_path_factory.mktemp("elsewhere") / "sent.html"))


@needs_browser
def test_alone_it_has_its_pictures_and_its_numbers(one_browser: Browser, alone: Path) -> None:
    one_browser.open(alone, 1400)
    assert one_browser.run(SEEN) and one_browser.complaints == []
    table = one_browser.run("document.querySelector('a[download]').href.split(',')[1]")
    assert base64.b64decode(table).startswith(b"comparison,leaf,")


@needs_browser
@pytest.mark.skipif(shutil.which("pdfimages") is None, reason="needs pdfimages")
def test_its_pictures_are_on_paper(one_browser: Browser, alone: Path, tmp_path: Path) -> None:
    one_browser.open(alone, 1400)
    paper = one_browser.call("Page.printToPDF", preferCSSPageSize=True)["data"]
    (tmp_path / "page.pdf").write_bytes(base64.b64decode(paper))
    found = subprocess.run(["pdfimages", "-list", tmp_path / "page.pdf"], capture_output=True, text=True, check=True)
    assert found.stdout.count(" image ") >= one_browser.run("document.images.length")


@needs_browser
@pytest.mark.skipif(shutil.which("pdfimages") is None, reason="needs pdfimages")
def test_a_picture_and_its_caption_are_on_one_sheet(one_browser: Browser, alone: Path, tmp_path: Path) -> None:
    square = f"data:image/png;base64,{base64.b64encode(encode_png(np.zeros((1000, 1000, 3), np.uint8))).decode()}"
    figures = "".join(f'<figure><img src="{square}"><figcaption>caption{k}</figcaption></figure>' for k in range(7))
    text = re.sub("<figure.*</figure>", figures, alone.read_text(encoding="utf-8"), flags=re.DOTALL)
    (tmp_path / "report.html").write_text(text, encoding="utf-8")
    one_browser.open(tmp_path / "report.html", 1400)
    paper = tmp_path / "page.pdf"
    paper.write_bytes(base64.b64decode(one_browser.call("Page.printToPDF", preferCSSPageSize=True)["data"]))
    listed = subprocess.run(["pdfimages", "-list", paper], capture_output=True, text=True, check=True).stdout
    words = subprocess.run(["pdftotext", paper, "-"], capture_output=True, text=True, check=True).stdout
    pictures = [int(line.split()[0]) for line in listed.splitlines() if " image " in line]
    captions = [k for k, sheet in enumerate(words.split("\f"), 1) for _ in re.findall(r"caption\d", sheet)]
    assert len(captions) == 7 and sorted(pictures) == captions and len({*captions}) <= 4


@needs_browser
def test_a_finger_hits_every_control_and_each_has_a_name(one_browser: Browser, alone: Path) -> None:
    one_browser.open(alone, 390)
    controls = "[...document.querySelectorAll('a, button, summary, input[type=search], .tools label')]"
    seen = f"{controls}.filter((one) => one.getClientRects().length && one.getClientRects()[0].height < 44)"
    assert one_browser.run(f"{seen}.map((one) => one.outerHTML.slice(0, 120))") == []
    named = "[...document.querySelectorAll('figure button')].map((one) => one.ariaLabel)"
    names = one_browser.run(named)
    assert names and len(names) == len(set(names))


@needs_browser
def test_a_wide_table_keeps_its_first_column(one_browser: Browser, alone: Path) -> None:
    one_browser.open(alone, 700)
    place = "document.querySelector('table.rows tbody th').getBoundingClientRect().left"
    scroll = "document.querySelector('.scroll')"
    one_browser.run(f"{scroll}.style.width = '200px'; 0")
    before = one_browser.run(place)
    one_browser.run(f"{scroll}.scrollLeft = 1000; 0")
    assert one_browser.run(f"{scroll}.scrollLeft") > 0 and one_browser.run(place) == before


def test_a_page_beyond_the_size_says_so_and_leaves_its_pictures_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = turning_page(tmp_path / "small").read_text()
    assert 'src="figures/' not in text and "send both" not in text and 'src="data:image/png;base64,' in text
    monkeypatch.setattr(stills, "LARGEST_PAGE", 1000)
    page = turning_page(tmp_path / "large")
    assert 'src="figures/' in page.read_text() and "more than 15 MB" in page.read_text()
    assert all(file.exists() for file in (page.parent / "figures").iterdir())


def test_the_size_counts_what_the_page_would_hold(tmp_path: Path) -> None:
    import numpy as np

    (tmp_path / "a.png").write_bytes(encode_png(np.zeros((9, 9, 3), dtype=np.uint8)))
    found, size = stills.addresses(tmp_path, ["a.png"], 10)
    assert size == 10 + len(found["a.png"].partition(",")[2])
