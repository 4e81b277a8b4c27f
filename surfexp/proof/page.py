"""The page of claims: one file that loads nothing, and whose verdict is that of the browser which reads it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from functools import cache
from html import escape
from importlib.resources import files

from surfexp.proof.claim import Claim
from surfexp.viewer.page import policy_of

# in the order in which a page runs them; the last one alone knows the page
SCRIPTS = (
    "arrays.js",
    "sha256.js",
    "triangles.js",
    "ldlt.js",
    "duality_gap.js",
    "spectrum.js",
    "signs.js",
    "verdicts.js",
    "page.js",
)
LARGEST = 5_000_000
NOT_PROVED = (
    "That the arrays are those of your data. Compare the SHA-256 of vertices, faces and map, which stands under each claim, "
    "with the one of your own arrays: float64 and int32, little-endian, row after row. Where a claim has an array rows, its "
    "vertices and its map are these rows of yours, and its faces are those among them, by their new numbers. Coordinates above "
    "1e25 or all below 1e-25 are divided by a power of two.",
    "That the mesh, the map and the parameters suit the question. The page computes what follows from them.",
    "That the scripts of the page are right. They are plain text in the source of the page. Who changes them can make any page "
    "green: compare them with those of the package, or trust the place where you got the page.",
    "More than rounding allows. What a comparison may differ by is a bound of rounding to first order, shown beside it.",
)


@cache
def asset(name: str) -> str:
    """Return the text of a file of the page."""
    return (files("surfexp.proof") / "assets" / name).read_text(encoding="utf-8")


def claims_page(claims: Sequence[Claim], title: str) -> str:
    """Return a page that computes its claims when it is opened, without a server and without a net.

    Parameters
    ----------
    claims : sequence of Claim
    title : str

    Returns
    -------
    str
        HTML.

    Raises
    ------
    ValueError
        If it would take more than 5 MB.
    """
    described = json.dumps([claim.described() for claim in claims]).replace("<", "\\u003c").replace(">", "\\u003e")
    style, scripts = asset("page.css"), [*map(asset, SCRIPTS)]
    check_size(len(described) + len(style) + sum(map(len, scripts)))
    sections = "\n".join(_section(claim) for claim in claims)
    run = "\n".join(f"<script>{script}</script>" for script in scripts)
    limits = "\n".join(f"<li>{limit}</li>" for limit in NOT_PROVED)
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy_of(style, scripts)}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>{style}</style>
</head>
<body>
<main>
<h1>{escape(title)}</h1>
<p id="verdict" class="verdict" role="status">Nothing is computed yet.</p>
<noscript><p class="verdict fails">Nothing is proved: the page computes where scripts may run.</p></noscript>
<p>This browser assembles the operator from vertices and faces and computes each number again. It writes what each claim
says from these numbers; one that does not come out fails.
<a href="#limits">It does not prove that the arrays are those of your data.</a></p>
{sections}
<section>
<h2 id="limits">What this page does not prove</h2>
<ul>
{limits}
</ul>
<table><tbody id="bytes"></tbody></table>
</section>
</main>
<script type="application/json" id="claims" data-sha256="{hashlib.sha256(described.encode()).hexdigest()}">{described}</script>
{run}
</body>
</html>
"""


def check_size(size: int) -> None:
    """Refuse a page of more bytes than browsers read at ease.

    Raises
    ------
    ValueError
        Naming both sizes.
    """
    if size > LARGEST:
        raise ValueError(f"the page would take {size / 1e6:.1f} MB, at most 5: take fewer eigenpairs or a coarser mesh")


def _section(claim: Claim) -> str:
    return f"""<section class="claim">
<h2>{escape(claim.kind.capitalize())}</h2>
<p></p>
<p class="verdict">Not computed yet.</p>
<table><thead><tr><th></th><th>what</th><th>computed here</th><th>stated</th><th>may differ by</th></tr></thead>
<tbody></tbody></table>
<details><summary>Bytes of the arrays, to compare with your own</summary><table><tbody></tbody></table></details>
</section>"""
