"""A finished picture, or drawing, and its caption."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Figure:
    """A still picture.

    Parameters
    ----------
    pixels : (height, width, 3) uint8
    caption : str
        One or two sentences: what is seen, its unit, and the figure of the dissertation that it answers.
    title : str
    metrics : dict of str to float
    notes : tuple of str
        As in `Surface`.
    svg : str
        The same in lines and letters, where it is a plot; empty where surfaces are seen.
    """

    pixels: NDArray[np.uint8]
    caption: str = ""
    title: str = ""
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    svg: str = ""


def compare(reference: str) -> str:
    """The sentence, after a space, that sends a reader to a figure of the dissertation; nothing where there is none."""
    return f" Compare {reference} of the dissertation." if reference else ""


def whole(number: float) -> str:
    """A number without decimals as tables write it, with thin spaces between thousands."""
    return f"{number:,.0f}".replace(",", "\u202f")


def sentence(text: str) -> str:
    """A text with a capital at its beginning; a file's name (lh.thickness, white_left) is left as it is."""
    return text[:1].upper() + text[1:] if _is_prose(text.split(" ")[0]) else text


def noun(name: str) -> str:
    """The name of a surface with its article, "a torus", "an ellipsoid"; a file's name as it is."""
    if not _is_prose(name):
        return name
    return f"{'an' if name[:1].lower() in tuple('aeiou') else 'a'} {name}"


def _is_prose(name: str) -> bool:
    return not {*"._/"} & {*name}
