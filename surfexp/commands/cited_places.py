"""`surfexp info 2.2`: the experiments that belong to a table, a figure or another place of the dissertation."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from surfexp.lab.errors import UserError
from surfexp.reproduction.statements import Statement, statements

KINDS = ("table", "figure", "section", "equation", "theorem", "lemma", "remark", "part", "chapter", "model")
NUMBER = r"\(?(\d+(?:\.\d+)*)\)?"
PLACE = re.compile(rf"(?:({'|'.join(KINDS)})\s+)?{NUMBER}", re.IGNORECASE)
CITED = re.compile(rf"({'|'.join(KINDS)})s?\s+{NUMBER}", re.IGNORECASE)

Place = tuple[str, str]


def asked_place(text: str) -> Place | None:
    """Return kind ("" if it is not said) and number of a place, None if the text is none."""
    found = PLACE.fullmatch(" ".join(text.split()))
    return ((found[1] or "").lower(), found[2]) if found else None


def places_of(document: Any) -> Iterator[Place]:
    """Yield the places that an experiment's file names: of its claims, its figures and headings, and its chapter."""
    if isinstance(document, dict):
        for key, value in document.items():
            if key == "chapter" and isinstance(value, list):
                yield "chapter", str(value[0])
            elif key == "published" and isinstance(value, dict):
                for source in map(str, value):
                    yield from ((kind.lower(), number) for kind, number in CITED.findall(source))
            elif key in ("reference", "title", "caption") and isinstance(value, str):
                yield from ((kind.lower(), number) for kind, number in CITED.findall(value))
            else:
                yield from places_of(value)
    elif isinstance(document, list):
        for item in document:
            yield from places_of(item)


def stated_at(place: Place) -> list[Statement]:
    """Return what the dissertation states at a place; of a number without a kind, at every place of that number."""
    kind, number = place
    return [item for item in statements() if item.place[1] == number and kind in ("", item.place[0])]


def experiments_at(place: Place, documents: dict[str, Any]) -> dict[str, list[str]]:
    """Return the experiments that name a place, each with the places as it names them.

    Parameters
    ----------
    place : tuple of str
        Kind and number; of a number without a point and without a kind, the chapter.
    documents : dict
        Contents of experiment files by name.

    Raises
    ------
    UserError
        If there is none, with the places of that chapter that are named.
    """
    kind, number = place
    if not kind and "." not in number:
        kind = "chapter"
    named = {name: dict.fromkeys(places_of(document)) for name, document in documents.items()}
    for item in statements():
        for name in (*item.verdicts, *item.ours):
            if name in named:
                named[name][item.place] = None
    fitting = {
        name: [f"{of} {at}" for of, at in places if at == number and kind in ("", of)] for name, places in named.items()
    }
    found = {name: places for name, places in fitting.items() if places}
    if not found:
        chapter = number.partition(".")[0]
        near = {item for places in named.values() for item in places if item[1].startswith(f"{chapter}.")}
        known = ", ".join(f"{of} {at}" for of, at in sorted(near, key=lambda item: (_numbers(item[1]), item[0])))
        raise UserError(
            f"no experiment is about {f'{kind} {number}'.strip()}; of chapter {chapter} they are about: {known or 'nothing'}"
        )
    return found


def _numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(".")]
