"""PNG bytes: exact while light, alike when not, and always the same."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import uniform_filter

from surfexp.figures.encode import LIGHT_BYTES, encode_png


def decoded(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(data)).convert("RGB"))


def textured(colors: int) -> np.ndarray:
    """A picture too heavy to stay exact: blue and red waves with fine grain."""
    x = np.linspace(0.0, 30.0, 700)
    wave = 0.5 + 0.5 * np.sin(x[:, None]) * np.cos(1.3 * x[None, :])
    grain = np.random.default_rng(0).normal(0.0, 0.02, (700, 700))
    red = np.clip(wave + grain, 0.0, 1.0)
    channels = [red, 0.5 + 0.3 * red, 1.0 - red] if colors == 1 else [red, red.T, np.roll(red, 90, 0)]
    return np.rint(255.0 * np.stack(channels, axis=2)).astype(np.uint8)


def test_light_pictures_are_exact() -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (40, 50, 3)).astype(np.uint8)
    assert (decoded(encode_png(pixels)) == pixels).all()


def test_heavy_pictures_get_a_palette_whose_local_mean_is_right() -> None:
    pixels = textured(1)
    data = encode_png(pixels)
    assert Image.open(BytesIO(data)).mode == "P"
    difference = uniform_filter(decoded(data).astype(float) - pixels, (5, 5, 0))
    assert np.percentile(np.abs(difference).max(axis=2), 99.0) < 6.0


def test_paper_stays_white_beside_what_is_nearly_white() -> None:
    pixels = textured(1)
    pixels[350:] = 255 - pixels[350:] // 24
    pixels[:40] = 255
    data = encode_png(pixels)
    assert Image.open(BytesIO(data)).mode == "P"
    assert (decoded(data)[:39] == 255).all()


def test_pictures_whose_colours_a_palette_misses_stay_exact() -> None:
    # grey wherever the palette is looked for, and coloured in between
    pixels = np.random.default_rng(2).integers(0, 256, (400, 400, 3)).astype(np.uint8)
    pixels[..., 2] = 0
    pixels[::3, ::3] = 128
    data = encode_png(pixels)
    assert len(data) > LIGHT_BYTES and (decoded(data) == pixels).all()


def test_bytes_are_the_same_again() -> None:
    for pixels in (textured(1), textured(3)[:200, :200]):
        assert encode_png(pixels) == encode_png(pixels.copy())


@pytest.mark.parametrize("pixels", [np.zeros((4, 4), np.uint8), np.zeros((4, 4, 3)), np.zeros((0, 4, 3), np.uint8)])
def test_other_arrays_are_refused(pixels: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"expected \(height, width, 3\) uint8"):
        encode_png(pixels)
