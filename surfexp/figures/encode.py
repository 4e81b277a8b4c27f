"""Pictures as PNG bytes, the same for the same pixels."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image as PillowImage
from scipy.ndimage import uniform_filter

# a picture that is lighter than this stays exact
LIGHT_BYTES = 200_000
# what is so much heavier after quick compression is heavy after the best one
QUICK, PROBABLY_HEAVY = 1, 2.5
# of pictures that are not made for a page
EXACT = 5
# dithering is not seen while the means over 5 x 5 pixels differ by less than this, of 255, nearly everywhere
WINDOW, VISIBLE_DIFFERENCE, PERCENTILE = 5, 16.0, 99.9
# the palette is found on every third pixel of every third row
THINNING = 3


def encode_png(pixels: NDArray[np.uint8]) -> bytes:
    """PNG of a picture: exact while that is light, else with a dithered palette of 256 colours where that is not seen.

    Parameters
    ----------
    pixels : (height, width, 3) uint8

    Raises
    ------
    ValueError
        If the array has another shape or type.
    """
    if pixels.ndim != 3 or pixels.shape[2] != 3 or pixels.dtype != np.uint8 or not pixels.size:
        raise ValueError(f"pixels have shape {pixels.shape} and type {pixels.dtype}, expected (height, width, 3) uint8")
    picture = PillowImage.fromarray(np.ascontiguousarray(pixels))
    heavy = len(_png(picture, QUICK)) > PROBABLY_HEAVY * LIGHT_BYTES
    exact = b"" if heavy else _png(picture)
    if exact and len(exact) <= LIGHT_BYTES:
        return exact
    dithered = _dithered(picture, pixels)
    if not _looks_same(dithered, pixels):
        return exact or _png(picture)
    small = _png(dithered)
    return exact if exact and len(exact) < len(small) else small


def exact_png(pixels: NDArray[np.uint8]) -> bytes:
    """PNG of a picture, every pixel as it is, in a quarter of the time that the lightest one takes.

    Parameters
    ----------
    pixels : (height, width, 3) uint8
    """
    return _png(PillowImage.fromarray(np.ascontiguousarray(pixels)), EXACT)


def _dithered(picture: PillowImage.Image, pixels: NDArray[np.uint8]) -> PillowImage.Image:
    """The picture in 255 colours near its own, and white, so that paper stays clean."""
    sparse = PillowImage.fromarray(np.ascontiguousarray(pixels[::THINNING, ::THINNING]))
    palette = sparse.quantize(255, method=PillowImage.Quantize.MEDIANCUT, kmeans=1)
    colors = [*(palette.getpalette() or []), *[255] * 768][: 3 * 255] + [255] * 3
    palette.putpalette(colors)
    indices = np.array(picture.quantize(palette=palette, dither=PillowImage.Dither.FLOYDSTEINBERG))
    # Pillow looks colours up in cells four levels wide, in which white may meet its neighbours
    indices[(pixels == 255).all(axis=2)] = 255
    dithered = PillowImage.fromarray(indices)
    dithered.putpalette(colors)
    return dithered


def _looks_same(picture: PillowImage.Image, pixels: NDArray[np.uint8]) -> bool:
    difference = np.asarray(picture.convert("RGB"), dtype=np.float32) - pixels
    local = np.abs(uniform_filter(difference, (WINDOW, WINDOW, 0))).max(axis=2)
    return bool(np.percentile(local, PERCENTILE) <= VISIBLE_DIFFERENCE)


def _png(picture: PillowImage.Image, level: int | None = None) -> bytes:
    """At a level of compression, or as small as it gets, which takes ten times as long."""
    stream = BytesIO()
    picture.save(stream, format="PNG", **({"optimize": True} if level is None else {"compress_level": level}))
    return stream.getvalue()
