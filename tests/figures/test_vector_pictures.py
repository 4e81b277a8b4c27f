"""Pictures as drawings: surfaces are pictures, words and bars are letters and lines, and all is the same each time."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx

BALL = sx.shape("icosphere", levels=2)


def saved(path: Path) -> bytes:
    sx.plot(BALL, BALL.mesh.vertices[:, 2], label="height", unit="mm", width=400).save(path)
    return path.read_bytes()


def test_a_drawing_has_the_surface_as_a_picture_and_its_words_as_letters(tmp_path: Path) -> None:
    document = saved(tmp_path / "ball.pdf")
    assert document.startswith(b"%PDF") and b"/FontFile2" in document and b"/Subtype /Image" in document
    drawing = saved(tmp_path / "ball.svg").decode()
    assert drawing.count("<image") >= 1 and drawing.count("<path") > 10
    widths = [float(width) for width in re.findall(r'<image[^>]* width="([\d.]+)"', drawing, flags=re.DOTALL)]
    assert max(widths) > 100


@pytest.mark.parametrize("suffix", ["svg", "pdf", "png"])
def test_a_picture_is_the_same_each_time(tmp_path: Path, suffix: str) -> None:
    assert saved(tmp_path / f"one.{suffix}") == saved(tmp_path / f"two.{suffix}")


def test_the_picture_of_a_drawing_is_that_of_the_pixels(tmp_path: Path) -> None:
    from surfexp.figures.panel import surface_panel, vector_panel

    picture = sx.plot(BALL, np.sign(BALL.mesh.vertices[:, 2]), width=400)
    assert vector_panel(picture.views, "svg", width=400).count(b"<image") >= len(picture.views)
    assert np.array_equal(surface_panel(picture.views, width=400).pixels, picture.figure.pixels)
