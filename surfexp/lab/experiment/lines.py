"""Where in an experiment's file the thing stands that an error names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

# what a message puts into quotation marks; OPTION = VALUE, as pydantic's complaints are written out; (a claim)
NAMED = re.compile(r"'([^']+)'|([\w/.-]+) = |claim \d* ?\((.{5,}?)\)")


def with_line(message: str, file: Path) -> str:
    """Return a message with the file and the line of the first thing that it names and the file holds.

    Parameters
    ----------
    message : str
        With names in quotation marks, or as `kind/plugin.option = value: reason`.
    file : Path
        YAML that can be read.

    Returns
    -------
    str
        The message as it is where the file holds nothing of what it names.
    """
    import yaml

    lines: dict[str, int] = {}
    for word, line in _words(yaml.compose(file.read_text(encoding="utf-8"), Loader=yaml.SafeLoader), set()):
        lines.setdefault(word, line)
    found = NAMED.findall(message)
    words = [word for quoted, option, _ in found for word in (quoted, option, option.rpartition(".")[2])]
    places = [lines[word] for word in words if word in lines and word]
    places += [line for _, _, claim in found if claim for word, line in lines.items() if word.startswith(claim)]
    return f"{file}, line {places[0]}: {message}" if places else message


def _words(node: Any, seen: set[int]) -> Iterator[tuple[str, int]]:
    """Every key and value of a YAML document with its line, dotted names by their parts too."""
    if node is None or id(node) in seen:
        return
    seen.add(id(node))
    if isinstance(node.value, str):
        yield " ".join(node.value.split()), node.start_mark.line + 1
        if re.fullmatch(r"\w+(\.\w+)+", node.value):
            yield node.value.rpartition(".")[2], node.start_mark.line + 1
        return
    for part in node.value:
        for child in part if isinstance(part, tuple) else [part]:
            yield from _words(child, seen)
