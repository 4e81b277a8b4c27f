"""A drawing for print: as PDF, and in pixels at 300 dots an inch."""

from __future__ import annotations

from importlib.util import find_spec
from io import BytesIO

from surfexp.extras import MissingExtra

DOTS_PER_INCH = 300
PACKAGES = {"reportlab": "reportlab", "resvg_py": "resvg-py", "svglib": "svglib"}


def require_printing() -> None:
    """Refuse to begin where a converter is missing.

    Raises
    ------
    MissingExtra
        Naming what to install.
    """
    missing = [package for module, package in PACKAGES.items() if find_spec(module) is None]
    if missing:
        verb = "is" if len(missing) == 1 else "are"
        raise MissingExtra(
            f"--print needs {', '.join(missing)}, which {verb} not installed: pip install 'surfexp[print]'"
        )


def as_pdf(svg: str) -> bytes:
    """Return a drawing, which has to be one that `is_still`, as one page of its own size; lines stay lines."""
    from reportlab.graphics import renderPDF
    from svglib.svglib import svg2rlg

    drawing, sink = svg2rlg(BytesIO(svg.encode())), BytesIO()
    if drawing is None:
        raise ValueError("its drawing cannot be read as SVG")
    renderPDF.drawToFile(drawing, sink, autoSize=1)
    return sink.getvalue()


def as_png(svg: str, dots_per_inch: int = DOTS_PER_INCH) -> bytes:
    """Return a drawing in pixels, on white."""
    import resvg_py

    return bytes(resvg_py.svg_to_bytes(svg_string=svg, dpi=dots_per_inch, background="white"))
