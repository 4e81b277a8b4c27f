"""The site: `make site` builds it into build/site, with warnings as errors; it asks no other host and reads offline."""

from __future__ import annotations

import shutil
from importlib import metadata
from pathlib import Path
from typing import Any

from docs_registry import write_registry
from docs_turning import write_picture
from latex2mathml.converter import convert
from sphinx.application import Sphinx

DOCS = Path(__file__).parent
PROGRAMS = DOCS / "generated" / "programs"  # examples write files where they stand
shutil.copytree(DOCS.parent / "examples", PROGRAMS, ignore=shutil.ignore_patterns("plugin_package"), dirs_exist_ok=True)

PICTURE = DOCS / "generated" / "turning" / "picture.html"
write_picture(PICTURE)
write_registry(DOCS / "generated")

project = "surfexp"
author = copyright = "The surfexp developers"
version = release = metadata.version("surfexp")
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = ["inside/*.py", "generated/examples/*.ipynb", "sg_execution_times.rst", "generated/programs/*"]
nitpicky = False
html_theme = "furo"
html_title = f"surfexp {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_extra_path = ["generated/turning"]
html_copy_source = False
html_math_renderer = "mathml"
templates_path: list[str] = []
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence", "attrs_inline"]
myst_heading_anchors = 3
autosummary_generate = True
autodoc_typehints = "none"
numpydoc_show_class_members = False
sphinx_gallery_conf = {
    "examples_dirs": [str(PROGRAMS)],
    "gallery_dirs": ["generated/examples"],
    "filename_pattern": r"\.py$",
    "image_scrapers": ("docs_scraper.pictures",),
    "show_memory": False,
    "write_computation_times": False,
    "show_signature": False,
    "download_all_examples": False,
    "remove_config_comments": True,
    "default_thumb_file": str(DOCS / "parcellation.png"),
    "abort_on_example_error": True,
}


def _inline(translator: Any, node: Any) -> None:
    translator.body.append(convert(node.astext()))
    raise _skip()


def _block(translator: Any, node: Any) -> None:
    translator.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise _skip()


def _skip() -> Exception:
    from docutils.nodes import SkipNode

    return SkipNode()


def _title(app: Sphinx, name: str, source: list[str]) -> None:
    """Make the question that opens an example the title of its page."""
    if name.startswith("generated/examples/") and "\n===" not in source[0]:
        head, label, rest = source[0].partition(f".. _sphx_glr_{name.replace('/', '_')}.py:\n\n")
        question, _, rest = rest.partition("\n")
        source[0] = f"{head}{label}{question}\n{'=' * len(question)}\n{rest}"


def setup(app: Sphinx) -> None:
    """Write formulas as MathML, which browsers show without a script; give examples their titles."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("source-read", _title)
