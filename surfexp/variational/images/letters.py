"""The picture "characters": text in a bitmap font of five by seven dots."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter

from surfexp.contract.arrays import Floats

# five columns for each glyph, the lowest bit on top
GLYPHS = {
    **{
        "A": "7E1111117E",
        "B": "7F49494936",
        "C": "3E41414122",
        "D": "7F4141221C",
        "E": "7F49494941",
        "F": "7F09090901",
    },
    **{
        "G": "3E4149497A",
        "H": "7F0808087F",
        "I": "00417F4100",
        "J": "2040413F01",
        "K": "7F08142241",
        "L": "7F40404040",
    },
    **{
        "M": "7F020C027F",
        "N": "7F0408107F",
        "O": "3E4141413E",
        "P": "7F09090906",
        "Q": "3E4151215E",
        "R": "7F09192946",
    },
    **{
        "S": "4649494931",
        "T": "01017F0101",
        "U": "3F4040403F",
        "V": "1F2040201F",
        "W": "3F4038403F",
        "X": "6314081463",
    },
    **{
        "Y": "0708700807",
        "Z": "6151494543",
        "0": "3E5149453E",
        "1": "00427F4000",
        "2": "4261514946",
        "3": "2141454B31",
    },
    **{
        "4": "1814127F10",
        "5": "2745454539",
        "6": "3C4A494930",
        "7": "0171090503",
        "8": "3649494936",
        "9": "064949291E",
    },
    **{" ": "0000000000", "-": "0808080808", ".": "0060600000"},
}


def letters(text: str = "SURF\nACES", size: int = 512, ink: float = 0.0, paper: float = 255.0) -> Floats:
    """(size, size) picture of two levels with lines of text, as large as fits.

    Parameters
    ----------
    text : str
        Capital letters, digits, blanks, "-" and "."; lines separated by newlines. Small letters are made capital.
    size : int
        Side of the picture in pixels.
    ink, paper : float
        The two levels.

    Raises
    ------
    ValueError
        If the text is blank or has a character without a glyph.
    """
    lines = text.upper().split("\n")
    unknown = sorted(set("".join(lines)) - set(GLYPHS))
    if unknown or not text.strip():
        raise ValueError(f"letters cannot draw {''.join(unknown) or text!r}; known are {''.join(GLYPHS)!r}")
    dots = np.zeros((9 * len(lines) + 1, 6 * max(map(len, lines)) + 3), dtype=bool)
    for row, line in enumerate(lines):
        left = (dots.shape[1] - 6 * len(line) + 1) // 2
        for place, glyph in enumerate(line):
            columns = np.frombuffer(bytes.fromhex(GLYPHS[glyph]), dtype=np.uint8)
            bits = np.unpackbits(columns[:, None], axis=1, bitorder="little").T[:7]
            dots[9 * row + 1 : 9 * row + 8, left + 6 * place : left + 6 * place + 5] = bits
    scale = size // max(dots.shape)
    if scale < 1:
        raise ValueError(f"letters has size = {size}; at least {max(dots.shape)} pixels are needed for {text!r}")
    canvas = np.zeros((size, size))
    top, left = ((size - scale * count) // 2 for count in dots.shape)
    enlarged = np.kron(dots, np.ones((scale, scale)))
    canvas[top : top + enlarged.shape[0], left : left + enlarged.shape[1]] = enlarged
    return np.where(gaussian_filter(canvas, 0.35 * scale) > 0.42, ink, paper)
