"""A file of an earlier version in the present spelling: edits in its text, so that comments, anchors and layout stay."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import yaml

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.former_spelling import present, present_dataset_file
from surfexp.lab.experiment.yaml_nodes import nodes_of
from surfexp.lab.experiment.yaml_text import WIDTH, anchor_of, below, entry, in_one_line

Edit = tuple[int, int, str]


def upgraded(text: str, of_datasets: bool = False) -> str:
    """Return the text of an experiment, or of a file of datasets, in the present spelling.

    Parameters
    ----------
    text : str
        YAML that can be read.
    of_datasets : bool
        Whether the file holds datasets alone, by name.

    Returns
    -------
    str
        The same text where nothing in it has another spelling.

    Raises
    ------
    UserError
        If the new text would not say what the old one says.

    Examples
    --------
    >>> print(upgraded("surface: {cup: {vertices: 4000}}  # with a handle"))
    surface: {name: cup, vertices: 4000}  # with a handle
    """
    convert = present_dataset_file if of_datasets else present
    document, scalars = nodes_of(text)
    now = convert(document)
    if now is document:
        return text
    found = text
    for start, end, new in sorted(_edits(document, now, text, scalars), reverse=True):
        found = found[:start] + new + found[end:]
    if yaml.safe_load(found) != convert(yaml.safe_load(text)):
        raise UserError("the file cannot be rewritten without changing what it says; rewrite it by docs/experiments.md")
    return found


def _edits(old: Any, new: Any, text: str, scalars: list[tuple[int, int]]) -> Iterator[Edit]:
    """Edits inside of a mapping or a list that stands below its key; what stands in braces is written anew as a whole."""
    if isinstance(old, Mapping):
        for (key, before), (name, after) in zip(old.items(), new.items(), strict=True):
            if key != name:
                yield key.start, key.end, in_one_line(name)
            if before is not after:
                if _alike(before, after):
                    yield from _edits(before, after, text, scalars)
                else:
                    yield _entry_anew(key, before, after, text, scalars)
    else:
        for before, after in zip(old, new, strict=True):
            if before is after:
                continue
            if _alike(before, after):
                yield from _edits(before, after, text, scalars)
            else:
                yield _item_anew(before, after, text, scalars)


def _alike(old: Any, new: Any) -> bool:
    """Whether the entries of two can be edited one by one."""
    same = isinstance(old, Mapping) == isinstance(new, Mapping) and isinstance(old, list) == isinstance(new, list)
    return same and isinstance(old, Mapping | list) and len(old) == len(new) and not old.flow  # type: ignore[union-attr]


def _column(text: str, place: int) -> int:
    return place - (text.rfind("\n", 0, place) + 1)


def _entry_anew(key: Any, old: Any, new: Any, text: str, scalars: list[tuple[int, int]]) -> Edit:
    column = _column(text, key.start)
    colon = text.index(":", key.end) + 1
    lines = entry(text[key.start : colon].rjust(column + colon - key.start), new, column)
    end = max(colon, getattr(old, "end", colon))
    written = "\n".join(lines)[column + colon - key.start :]
    return colon, end, written + _comments(text, colon, end, scalars, column)


def _item_anew(old: Any, new: Any, text: str, scalars: list[tuple[int, int]]) -> Edit:
    column = _column(text, old.start)
    line = in_one_line(new)
    is_claim = isinstance(new, Mapping) and "claim" in new
    if column + len(line) > WIDTH or is_claim:
        anchor = anchor_of(new).strip()
        lines = below(new, column)
        line = "\n".join([anchor, *lines] if anchor else [lines[0].lstrip(), *lines[1:]])
    return old.start, old.end, line + _comments(text, old.start, old.end, scalars, column)


def _comments(text: str, start: int, end: int, scalars: list[tuple[int, int]], column: int) -> str:
    """The comments of what is written anew, below it."""
    found, place = [], start
    while 0 <= (place := text.find("#", place)) < end:
        inside = [last for first, last in scalars if first <= place < last]
        if inside or (place and not text[place - 1].isspace()):
            place = inside[0] if inside else place + 1
            continue
        line = text[place:].partition("\n")[0]
        found.append("\n" + " " * column + line)
        place += len(line)
    return "".join(found)
