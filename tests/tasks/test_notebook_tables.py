"""Results at a prompt and as tables in notebooks: short, well formed, escaped, with the proof in them."""

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.contract.summary import Summary
from surfexp.experiments import ExperimentRun
from surfexp.mesh.surface import Surface
from surfexp.tasks.fingerprints import Fingerprints

SPHERE = sx.shape("icosphere", levels=2)
Z = SPHERE.mesh.vertices[:, 2]
BODY = sx.shape("ellipsoid", levels=2)


def fingerprints() -> Fingerprints:
    with tempfile.TemporaryDirectory() as folder:
        sx.write(f"{folder}/ball.ply", SPHERE)
        return sx.fingerprint(folder, count=4)


RESULTS = pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Surface(SPHERE.mesh, "a <b> & c", "mm", scalars={"<z>": Z}), ["a <b> & c", "162", "<z>", "mm²"]),
        (lambda: sx.eigenpairs(SPHERE, 4), ["4 eigenpairs", "complete", "yes", "largest residual"]),
        (lambda: sx.denoise(SPHERE, Z, noise=0.1), ["map after auto", "relative gap", "known values"]),
        (lambda: sx.align(BODY, BODY, 4), ["4 aligned modes", "single modes", "signs proved best", "yes"]),
        (lambda: sx.distance(BODY, BODY, 4), ["spectral distance", "lower bound", "proved least", "yes", "162"]),
        (lambda: sx.reeb_graph(SPHERE, Z, count=5), ["levels", "loops", "end points", "2"]),
        (fingerprints, ["fingerprints of 1 structures", "largest residual", "left out"]),
        (lambda: sx.segment(SPHERE, Z), ["two regions", "vertices brighter", "labelling gap"]),
    ],
)


@RESULTS
def test_tables_are_well_formed_and_hold_what_is_proved(make, words: list[str]) -> None:
    tree = ElementTree.fromstring(f"<div>{make()._repr_html_()}</div>")  # noqa: S314, the project's own page
    text = " ".join(tree.itertext())
    assert all(word in text for word in words), text


@RESULTS
def test_a_prompt_shows_one_line_with_the_same_words(make, words: list[str]) -> None:
    result = make()
    line = repr(result)
    assert line.startswith(f"<{type(result).__name__}: ") and "\n" not in line and len(line) < 400
    assert all(word in line for word in words), line


def test_everything_is_escaped_and_nothing_unknown_is_shown() -> None:
    shown = Summary("<script>", {"<a>": "<b>", "none": None, "empty": ""}, ["<i>"]).table()
    assert "<script>" not in shown and "<b>" not in shown and "<i>" not in shown
    assert "none" not in shown and "empty" not in shown
    facts = Summary("", {"count": 1000, "third": 1 / 3, "pi": float(np.pi), "sure": True}).rows()
    assert facts == {"count": "1,000", "third": "0.3333", "pi": "3.142", "sure": "yes"}


def test_a_line_stays_one_line_and_counts_the_notes() -> None:
    assert Summary("two\nlines", {"a": 1}, ["x", "y"]).line("Kind") == "<Kind: two lines, a 1; 2 notes>"
    assert repr(SPHERE.mesh) == "<TriangleMesh: 162 vertices, 320 faces>"


def test_a_picture_says_its_size_not_its_pixels() -> None:
    assert repr(sx.plot(SPHERE, Z, width=200)).startswith("<Picture: ") and len(repr(sx.plot(SPHERE, width=200))) < 60


def test_a_picture_is_written_in_a_known_format_or_not_at_all(tmp_path: Path) -> None:
    picture = sx.plot(SPHERE, width=200)
    with pytest.raises(ValueError, match=r"ball.bmp has an unknown format, choose one of \.png, \.svg"):
        picture.save(tmp_path / "ball.bmp")
    assert not list(tmp_path.iterdir())


def test_a_run_says_its_rows_and_shows_its_table() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"rmse": [1.0, 2.0], "failure": ["", "it died"]}, index=["a", "b"])
    found = ExperimentRun("mine", table, {}, Path("results/mine"), {})
    assert repr(found) == "<ExperimentRun: mine, rows 2, failed 1, figures 0, folder results/mine>"
    assert "it died" in found._repr_html_() and "<caption>mine</caption>" in found._repr_html_()
