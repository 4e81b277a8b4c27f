"""Numbers of a .npy file, refused unless they are real."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.arrays import Floats


def read_npy(path: Path) -> Floats:
    """Read a .npy file of real numbers as float64, in its own shape; nothing is unpickled.

    Raises
    ------
    ValueError
        If it is no array, or one of complex numbers, dates, records, texts or objects.
    """
    array = np.load(path, allow_pickle=False)
    if not isinstance(array, np.ndarray):
        raise ValueError("it is an archive of several arrays, one array is expected; save it with numpy.save")
    if array.dtype.kind not in "fiub":
        raise ValueError(f"it holds {array.dtype}, real numbers are expected")
    return array.astype(np.float64)
