"""The index of verdicts by chapter and place, a line each, and the pages of the chapters behind it."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from surfexp.reproduction.page import FOUND, HEADER, PLACE, line_of_cells, rows_of_section, sections_of
from surfexp.reproduction.pages import CHAPTERS_FOLDER, HEADING, INDEX
from surfexp.reproduction.statements import CHAPTERS, Statement, statements

BEYOND = "Beyond the dissertation"
COLUMNS = ("place", "what it says", "verdict", "published: ours", "experiment")
CHAPTER = re.compile(r"^`surfexp run .*, chapter (\d)$", re.MULTILINE)
SHOWN = 10


@dataclass(frozen=True)
class Judged:
    """A row of a section: its experiment, who states it and with which value, what was found, and the verdict."""

    experiment: str
    source: str
    quantity: str
    number: str
    verdict: str

    @property
    def place(self) -> str:
        """The place of the dissertation, empty where somebody else states it."""
        found = PLACE.fullmatch(self.source)
        return found[1] if found else ""

    @property
    def both(self) -> str:
        """The published value beside the number found."""
        found = PLACE.fullmatch(self.source)
        ours = f"{self.quantity.removeprefix('all ')} {self.number}"
        return f"{found[2]}: {ours}" if found else ours


def pages_of(document: str, stated: Sequence[Statement] | None = None) -> dict[str, str]:
    """Pages by name of a document of verdicts: the index, and one for each chapter that has experiments.

    Parameters
    ----------
    document : str
        Of `surfexp.reproduction.page.reproduction`, or pages that `read_pages` has read.
    stated : sequence of Statement, optional
        What the dissertation states; default: the list of the package.

    Returns
    -------
    dict
        Markdown by file name.
    """
    sections = sections_of(document)
    chapter_of = {name: int(found[1]) if (found := CHAPTER.search(text)) else 0 for name, text in sections.items()}
    judged = [row for name, text in sections.items() for row in judged_of(name, text)]
    index = [document.split(HEADING)[0].rstrip()]
    pages = {}
    for chapter in [*CHAPTERS, 0]:
        title = f"Chapter {chapter}: {CHAPTERS[chapter]}" if chapter else BEYOND
        inside = [name for name in sorted(sections) if chapter_of[name] == chapter]
        places = [item for item in (statements() if stated is None else stated) if item.chapter == chapter]
        if not inside and not places:
            continue
        index.append(f"## {title}")
        if places:
            index.append("\n".join(_table(places, judged, chapter_of)))
        if ours := _ours(inside, judged, chapter_of):
            index.append(f"Ours: {ours}.")
        if inside:
            back = f"[Index](../{INDEX}) · [what counts as a verdict](../verdicts.md)"
            pages[_file(chapter)] = f"# {title}\n\n{back}\n" + "".join(sections[name] for name in inside)
    return {INDEX: "\n\n".join(index) + "\n", **pages}


def judged_of(experiment: str, section: str) -> list[Judged]:
    """The rows of a section's table."""
    source, quantity = HEADER.index("source"), HEADER.index("quantity")
    rows = rows_of_section(section)
    return [Judged(experiment, row[source], row[quantity], row[FOUND], row[FOUND + 1].strip("*")) for row in rows]


def _table(places: Sequence[Statement], judged: Sequence[Judged], chapter_of: dict[str, int]) -> list[str]:
    by_place = defaultdict(list)
    for row in judged:
        by_place[row.place].append(row)
    lines = [line_of_cells(COLUMNS), "|" + "---|" * len(COLUMNS)]
    for item in places:
        rows = by_place[item.id]
        names = dict.fromkeys([*item.verdicts, *item.ours])
        links = ", ".join(_link(name, chapter_of) for name in names) or "–"
        numbers = "; ".join(row.both for row in rows[:SHOWN]) + ("; ..." if len(rows) > SHOWN else "")
        verdict = told(row.verdict for row in rows) if rows else "not computed"
        if item.none:
            verdict, numbers = f"none: {item.none}", ""
        lines.append(line_of_cells((item.id, item.states, verdict, numbers or "–", links)))
    return lines


def _ours(names: Sequence[str], judged: Sequence[Judged], chapter_of: dict[str, int]) -> str:
    counts = {name: [row.verdict for row in judged if row.experiment == name and not row.place] for name in names}
    return "; ".join(f"{_link(name, chapter_of)} {told(found)}" for name, found in counts.items() if found)


def told(verdicts: Iterable[str]) -> str:
    """Say verdicts with their number, the most frequent first; one alone without a number."""
    counts = Counter(verdicts)
    if counts.total() == 1:
        return next(iter(counts))
    return ", ".join(f"{number} {word}" for word, number in counts.most_common())


def _link(name: str, chapter_of: dict[str, int]) -> str:
    return f"[{name}]({_file(chapter_of[name])}#{name})" if name in chapter_of else name


def _file(chapter: int) -> str:
    return f"{CHAPTERS_FOLDER}/{f'chapter_{chapter}' if chapter else 'beyond'}.md"
