"""Pictures as PNG bytes, the same for the same pixels."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image as PillowImage

# of 255: what the eye does not see in a picture of smooth shading
MEAN_ERROR_LIMIT = 0.8
PEAK_ERROR_LIMIT = 8.0
PEAK_PERCENTILE = 99.9


def encode_png(pixels: NDArray[np.uint8]) -> bytes:
    """PNG of a picture, with a palette of 256 colours where that cannot be seen, in full colour otherwise.

    Parameters
    ----------
    pixels : (height, width, 3) uint8

    Raises
    ------
    ValueError
        If the array has another shape or type.
    """
    if pixels.ndim != 3 or pixels.shape[2] != 3 or pixels.dtype != np.uint8:
        raise ValueError(f"pixels have shape {pixels.shape} and type {pixels.dtype}, expected (height, width, 3) uint8")
    picture = PillowImage.fromarray(np.ascontiguousarray(pixels))
    palette = picture.quantize(256, method=PillowImage.Quantize.MEDIANCUT, kmeans=1, dither=PillowImage.Dither.NONE)
    error = np.abs(np.asarray(palette.convert("RGB"), dtype=np.int16) - pixels).max(axis=2)
    unseen = error.mean() <= MEAN_ERROR_LIMIT and np.percentile(error, PEAK_PERCENTILE) <= PEAK_ERROR_LIMIT
    stream = BytesIO()
    (palette if unseen else picture).save(stream, format="PNG", optimize=True)
    return stream.getvalue()
