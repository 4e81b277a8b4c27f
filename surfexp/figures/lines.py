"""Lines in space, drawn on a surface or through it, with a white casing that keeps them seen on every colour."""

from __future__ import annotations

from dataclasses import dataclass

from surfexp.contract.arrays import Floats, Integers

# pixels of white on either side
CASING, CASING_COLOR = 1.5, "#ffffff"


@dataclass(frozen=True, eq=False)
class Lines:
    """Segments in space.

    Parameters
    ----------
    points : (p, 3) float64
    segments : (s, 2) int64
    color : str
        As in CSS, six digits.
    width : float
        In pixels.
    through : bool
        Whether they are seen through the surface, as a skeleton inside is.
    casing : float
        Pixels of white on either side. Red on purple differs in hue alone; white beside it differs in lightness, which
        every eye sees.
    faces : (s,) int64, optional
        The face in which each segment lies.
    """

    points: Floats
    segments: Integers
    color: str
    width: float = 2.0
    through: bool = False
    casing: float = 0.0
    faces: Integers | None = None

    @property
    def strokes(self) -> tuple[tuple[str, float], ...]:
        """Colour and width of what is drawn, one over the other."""
        line = (self.color, self.width)
        return ((CASING_COLOR, self.width + 2.0 * self.casing), line) if self.casing else (line,)
