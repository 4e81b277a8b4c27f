"""Pictures for painting: those that scikit-image carries in its own package, and letters."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import numpy as np
from PIL import Image

from surfexp.contract.arrays import Floats
from surfexp.extras import MissingExtra, missing_line
from surfexp.variational.images.letters import letters

PACKAGED = {
    "cameraman": "camera.png",
    "astronaut": "astronaut.png",
    "coffee": "coffee.png",
    "cat": "chelsea.png",
    "rocket": "rocket.jpg",
    "coins": "coins.png",
    "brick": "brick.png",
    "grass": "grass.png",
    "gravel": "gravel.png",
    "moon": "moon.png",
    "page": "page.png",
    "text": "text.png",
}


def picture(name: str = "cameraman") -> Floats:
    """(h, w) or (h, w, 3) grey or colour levels 0..255 of a picture that is installed with scikit-image, or of "letters".

    Nothing is downloaded.

    Raises
    ------
    ValueError
        If the name is unknown.
    """
    if name == "letters":
        return letters()
    if name not in PACKAGED:
        raise ValueError(f"picture {name!r} is unknown, choose one of {', '.join([*PACKAGED, 'letters'])}")
    package = find_spec("skimage")
    if package is None or package.origin is None:
        raise MissingExtra(missing_line(f"picture {name!r}", ["skimage"]))
    return read_picture(Path(package.origin).parent / "data" / PACKAGED[name])


def read_picture(path: Path) -> Floats:
    """(h, w) or (h, w, 3) levels 0..255 of a picture file; transparency is dropped.

    Raises
    ------
    ValueError
        If the file is not a picture that Pillow reads.
    """
    try:
        with Image.open(path) as image:
            grey = image.mode in ("1", "L", "LA", "I", "F", "I;16")
            depth = 257.0 if image.mode == "I;16" else 1.0
            levels = image if image.mode in ("I", "F", "I;16") else image.convert("L" if grey else "RGB")
            return np.asarray(levels, dtype=np.float64) / depth
    except (OSError, SyntaxError, EOFError) as error:
        raise ValueError(f"{path} is not a readable picture: {error}") from error
