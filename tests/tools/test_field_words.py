"""The pages say things in the field's words; spelling is checked by `make lint`."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MADE = {"reproduction.md", "claim_faults.md", "mutation.md"}  # of statements in experiments and lines of code
PAGES = [
    page
    for page in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.md")]
    if page.name not in MADE and not {"generated", "reproduction"} & set(page.parts)
]
# a word of our own, and the field's
TERMS = {
    r"as printed": "as published",
    r"slabs?": "interlevel sets",
    r"classical scaling": "classical MDS",
    r"bias (is )?taken off": "debiased",
    r"never saw its person": "leave-one-group-out",
    r"least p\b": "minimum attainable p",
    r"one entrance": "entry point",
    r"let pass": "allow",
    r"extrapolated? to no mesh size": "Richardson extrapolation",
}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_uses_the_words_of_the_field(page: Path) -> None:
    text = " ".join(page.read_text(encoding="utf-8").split())
    found = {word: TERMS[word] for word in TERMS if re.search(rf"\b{word}\b", text, re.IGNORECASE)}
    assert not found, found


def test_there_are_pages() -> None:
    assert len(PAGES) > 40
