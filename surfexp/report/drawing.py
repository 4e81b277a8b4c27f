"""Drawings in stored results: shown where they are nothing but a drawing, for a folder of results may be a stranger's."""

from __future__ import annotations

import re

TAGS = frozenset(
    ("svg", "g", "path", "defs", "use", "clipPath", "rect", "style", "image", "text", "tspan", "title", "metadata")
)
TAG = re.compile(r"<\s*/?\s*([^\s/>]*)")
# what a drawing refers to lies in it: shapes by their names, pictures as bytes
REFERENCE = re.compile(r"""(?:href|src)\s*=\s*(?!"#[\w-]+"|"data:image/png;base64,[\w+/=\s]*")""")
HANDLER = re.compile(r"[\s\"']on\w+\s*=", re.IGNORECASE)
STYLE = re.compile(r"url\((?!#[\w-]+\))|@|javascript:|expression", re.IGNORECASE)
ENTITY = re.compile(r"&(?!(?:amp|lt|gt|quot|apos|#\d+|#x[0-9a-fA-F]+);)")


def is_still(svg: str) -> bool:
    """Return whether a text is an SVG drawing that runs nothing, loads nothing and links nowhere.

    Parameters
    ----------
    svg : str

    Examples
    --------
    >>> is_still('<svg xmlns="http://www.w3.org/2000/svg"><path d="M 0 0 L 1 1"/></svg>')
    True
    >>> is_still('<svg xmlns="http://www.w3.org/2000/svg"><script>alert(1)</script></svg>')
    False
    """
    begins = svg.startswith("<svg ") and svg.rstrip().endswith("</svg>")
    return (
        begins
        and set(TAG.findall(svg)) <= TAGS
        and not any(found.search(svg) for found in (REFERENCE, HANDLER, STYLE, ENTITY))
    )
