"""The files of the verdicts: an index, and a page for each chapter; read together they are one document."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

INDEX, CHAPTERS_FOLDER = "reproduction.md", "reproduction"
HEADING = "\n## "


def read_pages(place: Path) -> str:
    """Return the head and the sections of all verdicts of a folder, or of one page; empty where there are none."""
    if not place.is_dir():
        return place.read_text(encoding="utf-8") if place.exists() else ""
    index = place / INDEX
    head, *sections = index.read_text(encoding="utf-8").split(HEADING) if index.exists() else [""]
    chapters = sorted((place / CHAPTERS_FOLDER).glob("*.md"))
    if chapters:  # else the index is a page of its own sections
        sections = [part for page in chapters for part in page.read_text(encoding="utf-8").split(HEADING)[1:]]
    return head + "".join(HEADING + part.rstrip("\n") + "\n" for part in sections)


def write_pages(pages: Mapping[str, str], folder: Path) -> None:
    """Write pages by their names below a folder; a chapter's page that is no longer made is removed."""
    (folder / CHAPTERS_FOLDER).mkdir(parents=True, exist_ok=True)
    for page in (folder / CHAPTERS_FOLDER).glob("*.md"):
        if f"{CHAPTERS_FOLDER}/{page.name}" not in pages:
            page.unlink()
    for name, text in pages.items():
        (folder / name).write_text(text.rstrip("\n") + "\n", encoding="utf-8")
