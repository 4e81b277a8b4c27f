"""Pictures of examples for the gallery: what `sx.plot` returned, and open figures of matplotlib."""

from __future__ import annotations

from itertools import chain
from typing import Any

from sphinx_gallery.scrapers import figure_rst, matplotlib_scraper

from surfexp.tasks.pictures import Picture

_shown: set[int] = set()


def pictures(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any], **options: Any) -> str:
    """Save new pictures among the names of an example, and return the text that shows them."""
    files = []
    values = block_vars["example_globals"].values()
    for value in chain.from_iterable(value if isinstance(value, list) else [value] for value in values):
        if isinstance(value, Picture) and id(value) not in _shown:
            _shown.add(id(value))
            files.append(next(block_vars["image_path_iterator"]))
            value.save(files[-1])
    own = figure_rst(files, gallery_conf["src_dir"]) if files else ""
    return own + matplotlib_scraper(block, block_vars, gallery_conf, **options)
