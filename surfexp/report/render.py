"""Pages from templates: every text as written, scripts and one style inside, nothing from elsewhere."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from jinja2 import Environment, PackageLoader
from markupsafe import Markup, escape

from surfexp.records.written_numbers import format_number, short_name
from surfexp.report.metric_remarks import metric_remarks
from surfexp.report.words import duration, word
from surfexp.viewer.page import asset, policy_of


def render(template: str, scripts: Sequence[str] = (), **content: Any) -> str:
    """Return a page; a browser runs no script in it but our own, whatever titles, labels and names hold.

    Parameters
    ----------
    template : str
    scripts : sequence of str
        Names of the viewer's scripts, beside that of the tables.
    **content
        What the template shows.
    """
    loader = PackageLoader("surfexp.report", "templates")
    environment = Environment(loader=loader, autoescape=True)
    environment.filters.update(
        number=format_number,
        exact=exact,
        duration=duration,
        word=word,
        heading=short_name,
        prose=prose,
        metric_remarks=metric_remarks,
    )
    style, tables = (loader.get_source(environment, name)[0] for name in ("style.css", "tables.js"))
    style += asset("viewer.css")
    texts = [tables, *map(asset, scripts)]
    policy = policy_of(style, texts, "'self' data:")
    page = environment.get_template(template)
    own = {"style": Markup(style), "scripts": [*map(Markup, texts)]}  # noqa: S704, the package's own files
    return page.render(**own, policy=policy, **content)


def prose(text: str) -> Markup:
    """A text as the page shows it: everything as written, what stands between backticks as code."""
    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(text))))  # noqa: S704, the text is escaped before


def exact(value: float | None) -> str:
    """All digits of a number, by which a column is sorted; nothing where there is none."""
    return "" if value is None or value != value else repr(float(value)).replace("inf", "Infinity")
