"""Captions begin with a capital and have an article, but the name of a file is left as it is."""

from __future__ import annotations

import pytest

from surfexp.figures.figure import noun, sentence


@pytest.mark.parametrize(
    ("name", "first", "after"),
    [
        ("sphere", "Sphere", "a sphere"),
        ("ellipsoid", "Ellipsoid", "an ellipsoid"),
        ("half double torus", "Half double torus", "a half double torus"),
        ("Y", "Y", "a Y"),
        ("lh.thickness", "lh.thickness", "lh.thickness"),
        ("white_left", "white_left", "white_left"),
    ],
)
def test_a_name_in_a_caption(name: str, first: str, after: str) -> None:
    assert sentence(name) == first and noun(name) == after


def test_only_the_first_word_decides_on_the_capital() -> None:
    assert sentence("mean curvature of lh.white") == "Mean curvature of lh.white"
