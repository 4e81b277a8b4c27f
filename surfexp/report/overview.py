"""The overview of a results folder: every experiment with its lead picture, verdicts and cost, the newest first."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import Any

from markupsafe import Markup

from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store
from surfexp.records.table import Row
from surfexp.report.render import render
from surfexp.report.verdict import Verdict

FILE = "summary.json"
PICTURE = re.compile(r"[\w-]+\.(png|svg)")
# an index.html without this is somebody else's
MARK = '<meta name="generator" content="surfexp">'
LARGEST = 10**9


def write_summary(folder: Path, plan: Plan, rows: Sequence[Row], verdicts: Sequence[Verdict], picture: str) -> None:
    """Write beside a report what the overview shows of it."""
    summary = {
        "title": plan.settings.title,
        "question": re.split(r"(?<=[.?!])\s", plan.settings.description, maxsplit=1)[0],
        "date": datetime.now().isoformat(" ", "minutes"),
        "rows": len(rows),
        "failed": sum(bool(row.failure) for row in rows),
        "limited": sum(row.limited for row in rows),
        "seconds": round(sum(row.seconds for row in rows if row.seconds and math.isfinite(row.seconds))),
        "verdicts": Counter(item.verdict for item in verdicts),
        "picture": picture,
    }
    store.write_text(folder / FILE, json.dumps(summary, indent=1))


def write_overview(results: Path) -> None:
    """Write `index.html` from the summaries beside the reports; one that cannot be read is left out.

    A file of that name that somebody else wrote is left alone.
    """
    target = results / "index.html"
    if target.exists() and not is_ours(target):
        return
    pages = [page for file in results.glob(f"*/{FILE}") if (page := _read(file)) is not None]
    pages.sort(key=lambda page: page["date"], reverse=True)
    mark = Markup(MARK)  # noqa: S704, a constant of this module
    store.write_text(target, render("index.html.j2", pages=pages, mark=mark))


def is_ours(page: Path) -> bool:
    """Whether an overview was written here."""
    return page.is_file() and MARK in page.read_text(errors="replace")[:2000]


def _read(file: Path) -> dict[str, Any] | None:
    """A summary as the overview takes it: what others may have written is text and numbers, and leads nowhere else."""
    with suppress(OSError, ValueError, TypeError, KeyError, AttributeError, ArithmeticError, RecursionError):
        found = json.loads(file.read_text())
        texts = {key: _text(found[key]) for key in ("title", "question", "date", "picture")}
        numbers = {key: min(int(found[key]), LARGEST) for key in ("rows", "failed", "limited", "seconds")}
        verdicts = {_text(name): min(int(count), LARGEST) for name, count in found["verdicts"].items()}
        if not PICTURE.fullmatch(texts["picture"]):
            texts["picture"] = ""
        if (file.parent / "report.html").is_file():
            return {**texts, **numbers, "verdicts": verdicts, "name": file.parent.name}
    return None


def _text(value: Any) -> str:
    return str(value).encode(errors="replace").decode()
