"""Text and axes by matplotlib without a display: one style, whatever the user's settings are."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO, StringIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

DOTS_PER_INCH = 100
INK = "#222222"
QUIET = "#6b6b6b"
# of a plot in characters: one of many thousand marks is lighter in pixels
LONGEST_DRAWING = 1_000_000

STYLE = {
    # bundled with matplotlib, therefore the same everywhere
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": QUIET,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 1.0,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.8,
    "axes.grid": True,
    "axes.axisbelow": True,
    "lines.linewidth": 2.0,
    "lines.markersize": 6.0,
}


def points(pixels: float) -> float:
    """A length in typographic points, as matplotlib counts fonts and lines."""
    return 72.0 * pixels / DOTS_PER_INCH


@contextmanager
def canvas(width: int, height: int) -> Iterator[Any]:
    """A matplotlib figure of so many pixels, in the style of all pictures; draw it inside the context."""
    import matplotlib.style
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as MatplotlibFigure

    with matplotlib.style.context(["default", STYLE]):
        figure = MatplotlibFigure(figsize=(width / DOTS_PER_INCH, height / DOTS_PER_INCH), dpi=DOTS_PER_INCH)
        FigureCanvasAgg(figure)
        yield figure


def drawn(figure: Any) -> NDArray[np.uint8]:
    """(height, width, 3) pixels of a matplotlib figure."""
    figure.canvas.draw()
    return np.array(figure.canvas.buffer_rgba())[..., :3]


def vector(figure: Any, outlines: bool = True) -> str:
    """A matplotlib figure as SVG, the same bytes for the same figure; empty where it would be too long.

    Letters are outlines, so that they stand where they were measured on machines without the font too, or text.
    """
    import matplotlib as mpl

    sink = StringIO()
    with mpl.rc_context({"svg.hashsalt": "surfexp", "svg.fonttype": "path" if outlines else "none"}):
        figure.savefig(sink, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    text = re.sub(r"<!--.*?-->\s*", "", sink.getvalue(), flags=re.DOTALL)
    return text[text.index("<svg") :] if len(text) <= LONGEST_DRAWING else ""


def saved(figure: Any, form: str) -> bytes:
    """A matplotlib figure as SVG or PDF, the same bytes for the same figure; letters stay text in PDF, outlines in SVG."""
    import matplotlib as mpl

    sink = BytesIO()
    fonts = {"svg.hashsalt": "surfexp", "svg.fonttype": "path", "pdf.fonttype": 42}
    undated = {"svg": {"Date": None, "Creator": None}, "pdf": {"CreationDate": None, "Creator": None, "Producer": None}}
    with mpl.rc_context(fonts):
        figure.savefig(sink, format=form, metadata=undated[form])
    return sink.getvalue()
