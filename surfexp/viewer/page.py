"""One picture that turns, as a page of its own: to be put into another page, or sent."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from functools import cache
from html import escape
from importlib.resources import files

from surfexp.viewer.payload import BUDGET, Payload
from surfexp.viewer.scene import Scene

# in the order in which a page runs them; the library is the largest part of a page without surfaces
SCRIPTS = ("three.bundle.js", "arrays.js", "surface.js", "panel.js", "curve.js", "turning.js")
COLORS = """:root { --ink: #1c2330; --soft: #5b6575; --line: #dde2ea; --wash: #f5f7fa; --accent: #9d2235;
  color-scheme: light dark; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e8ee; --soft: #a3adbb; --line: #353d4a; --wash: #20262f; --accent: #ff9aa8; }
  body { background: #14181e; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; color: var(--ink); font: 16px/1.5 system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
h1 { font-size: 1.1rem; margin: .6rem 0; }
figure { margin: 0; }
figure img { width: 100%; height: auto; display: block; }
figcaption { color: var(--soft); font-size: .85rem; margin-top: .4rem; }
[hidden] { display: none !important; }
"""


@cache
def asset(name: str) -> str:
    """Return the text of a file of the viewer."""
    return (files("surfexp.viewer") / "assets" / name).read_text(encoding="utf-8")


def policy_of(style: str, scripts: Sequence[str], images: str = "data:") -> str:
    """Return the policy by which a browser applies this style, runs these scripts and loads nothing else.

    Parameters
    ----------
    style : str
    scripts : sequence of str
    images : str
        Sources of pictures.
    """
    return "; ".join(
        (
            "default-src 'none'",
            f"img-src {images}",
            f"style-src {_hash(style)}",
            f"script-src {' '.join(map(_hash, scripts))}",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )


def viewer_page(scene: Scene, *, title: str = "", caption: str = "", still: bytes = b"", budget: int = BUDGET) -> str:
    """Return a page whose surfaces turn: at once, or by a button below a still picture, as those of a report do.

    Parameters
    ----------
    scene : Scene
    title, caption : str
    still : bytes
        PNG that is seen at first, on paper, and where no script runs.
    budget : int
        Bytes that the surfaces may take.

    Returns
    -------
    str
        HTML that needs no other file and asks no host.

    Raises
    ------
    ValueError
        If the surfaces take more than the budget.
    """
    payload = Payload(budget)
    described = json.dumps(payload.add(scene)).replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
    style, scripts, name = COLORS + asset("viewer.css"), [*map(asset, SCRIPTS)], escape(title or "Surface")
    picture = f"data:image/png;base64,{base64.b64encode(still).decode()}"
    seen = f'<a href="{picture}"><img src="{picture}" alt="{name}"></a>' if still else ""
    heading = f"<h1>{escape(title)}</h1>\n" if title and not still else ""
    arrays = "\n".join(
        f'<script type="application/octet-stream" id="array-{key}">{text}</script>'
        for key, text in payload.arrays.items()
    )
    run = "\n".join(f"<script>{script}</script>" for script in scripts)
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy_of(style, scripts)}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name}</title>
<style>{style}</style>
</head>
<body class="alone">
<main>
<section>
{heading}<figure{"" if still else ' class="live"'}>{seen}
<script type="application/json" class="scene">{described}</script>
{"" if still else "<noscript>Where scripts may run, a surface turns here.</noscript>"}
<figcaption>{escape(caption)}</figcaption></figure>
</section>
</main>
{arrays}
{run}
</body>
</html>
"""


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
