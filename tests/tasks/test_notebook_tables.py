"""Results as small tables in notebooks: well formed, escaped, with the proof in them."""

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import surfexp as sx
from surfexp.html_table import html_table
from surfexp.mesh.surface import Surface
from surfexp.tasks.fingerprints import Fingerprints

SPHERE = sx.shape("icosphere", levels=2)
Z = SPHERE.mesh.vertices[:, 2]
BODY = sx.shape("ellipsoid", levels=2)


def fingerprints() -> Fingerprints:
    with tempfile.TemporaryDirectory() as folder:
        sx.write(f"{folder}/ball.ply", SPHERE)
        return sx.fingerprint(folder, count=4)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Surface(SPHERE.mesh, "a <b> & c", "mm", scalars={"<z>": Z}), ["a <b> & c", "162", "<z>", "mm²"]),
        (lambda: sx.eigenpairs(SPHERE, 4), ["4 eigenpairs", "complete", "yes", "largest residual"]),
        (lambda: sx.denoise(SPHERE, Z, noise=0.1), ["map after rof", "relative gap", "known values"]),
        (lambda: sx.align(BODY, BODY, 4), ["4 aligned modes", "single modes", "signs proved best", "yes"]),
        (lambda: sx.distance(BODY, BODY, 4), ["spectral distance", "lower bound", "proved least", "yes", "162"]),
        (lambda: sx.reeb_graph(SPHERE, Z, count=5), ["levels", "loops", "end points", "2"]),
        (fingerprints, ["fingerprints of 1 structures", "largest residual", "left out"]),
        (lambda: sx.segment(SPHERE, Z), ["two regions", "vertices brighter", "labelling gap"]),
    ],
)
def test_tables_are_well_formed_and_hold_what_is_proved(make, words: list[str]) -> None:
    tree = ElementTree.fromstring(f"<div>{make()._repr_html_()}</div>")  # noqa: S314, the project's own page
    text = " ".join(tree.itertext())
    assert all(word in text for word in words), text


def test_everything_is_escaped_and_nothing_unknown_is_shown() -> None:
    shown = html_table("<script>", {"<a>": "<b>", "none": None, "empty": ""}, ["<i>"])
    assert "<script>" not in shown and "<b>" not in shown and "<i>" not in shown
    assert "none" not in shown and "empty" not in shown
    assert "1,000" in html_table("", {"n": 1000}) and "0.3333" in html_table("", {"x": 1 / 3})
    assert "3.142" in html_table("", {"x": float(np.pi)})
