"""Plots as drawings: the same bytes each time, and nothing in them that runs, loads or links."""

from __future__ import annotations

import re
from io import BytesIO
from xml.etree import ElementTree

import numpy as np
import pytest

from surfexp.figures.figure import Figure
from surfexp.figures.interval_plot import interval_plot
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.report.drawing import is_still
from surfexp.tasks.pictures import Picture

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="9" height="9">'
RUNS = {
    "a script": "<script>alert(1)</script>",
    "a script of another name": "<SCRIPT>alert(1)</SCRIPT>",
    "a script in a space of names": '<s:script xmlns:s="http://www.w3.org/2000/svg">alert(1)</s:script>',
    "a handler": '<rect width="9" height="9" onclick="alert(1)"/>',
    "a handler after a quotation": '<rect width="9"onload="alert(1)"/>',
    "a link": '<a xlink:href="https://example.org"><rect width="9" height="9"/></a>',
    "a picture from elsewhere": '<image xlink:href="https://example.org/a.png"/>',
    "a picture that is a drawing": '<image href="data:image/svg+xml;base64,PHN2Zy8+"/>',
    "a shape from elsewhere": '<use href="other.svg#a"/>',
    "a reference without quotation marks": "<use href=#a/>",
    "a style from elsewhere": "<style>@import 'https://example.org/a.css';</style>",
    "a colour from elsewhere": '<rect style="fill: url(https://example.org/a.svg#b)"/>',
    "a page inside": "<foreignObject><p>words</p></foreignObject>",
    "an animation": '<set attributeName="href" to="javascript:alert(1)"/>',
    "an entity": "<text>&bomb;</text>",
    "a comment": "<!-- --><rect/>",
    "characters as they are": "<![CDATA[<script>alert(1)</script>]]>",
    "an instruction": "<?xml-stylesheet href='a.css'?>",
}


def plot() -> Figure:
    x = np.arange(1.0, 6.0)
    band = np.stack([x, x - 0.5, x + 0.5], axis=1)
    return sweep_plot(
        x, {"a < b & 'c'": x**2, '"onload=" <script>': band}, x_label="k", y_label="$k^2$", title="A title"
    )


def test_a_plot_is_a_drawing_too() -> None:
    figure = plot()
    assert figure.svg == plot().svg and is_still(figure.svg)
    root = ElementTree.fromstring(figure.svg)  # noqa: S314, our own
    width, height = (float(root.attrib[name].removesuffix("pt")) for name in ("width", "height"))
    assert width / height == pytest.approx(figure.pixels.shape[1] / figure.pixels.shape[0])
    assert len(figure.svg) < 60_000
    intervals = interval_plot({"one": (0.5, 0.4, 0.6)}, x_label="accuracy", title="")
    assert is_still(intervals.svg)


def test_a_drawing_is_saved_as_it_is(tmp_path) -> None:
    picture = Picture(plot())
    picture.save(tmp_path / "plot.svg")
    assert (tmp_path / "plot.svg").read_text(encoding="utf-8") == picture.figure.svg


def test_what_is_drawn_with_a_picture_inside_is_still() -> None:
    assert is_still(f'{HEAD}<image xlink:href="data:image/png;base64,iVBORw0KGgo=" width="9"/></svg>')


@pytest.mark.parametrize("body", RUNS.values(), ids=RUNS)
def test_what_runs_loads_or_links_is_no_drawing(body: str) -> None:
    assert is_still(f"{HEAD}<rect/></svg>")
    assert not is_still(f"{HEAD}{body}</svg>")


@pytest.mark.parametrize(
    "text", ["", "words", "<html></html>", f"<!DOCTYPE svg>{HEAD}</svg>", f"{HEAD}</svg><p>more</p>"]
)
def test_what_is_no_drawing_is_none(text: str) -> None:
    assert not is_still(text)


@pytest.mark.optional
def test_a_plot_for_print_has_its_size_and_no_pixels_in_its_lines() -> None:
    pytest.importorskip("svglib", reason="needs svglib: make optional")
    pytest.importorskip("resvg_py", reason="needs resvg-py: make optional")
    image_file = pytest.importorskip("PIL.Image")
    from surfexp.report.printing import as_pdf, as_png

    svg = plot().svg
    root = ElementTree.fromstring(svg)  # noqa: S314, our own
    inches = [float(root.attrib[side].removesuffix("pt")) / 72 for side in ("width", "height")]
    pixels = image_file.open(BytesIO(as_png(svg)))
    assert np.abs(np.array(pixels.size) - 300 * np.array(inches)).max() <= 1.0
    assert np.asarray(pixels.convert("L")).min() < 64  # letters are there
    page = as_pdf(svg)
    (box,) = re.findall(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)\s*\]", page)
    assert np.abs(np.array(box, dtype=float) - 72 * np.array(inches)).max() <= 0.1
    assert b"/Subtype /Image" not in page
