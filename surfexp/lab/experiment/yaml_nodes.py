"""A YAML document as mappings, lists and texts that know where they stand in the file, for edits that keep all else.

By hand: ruamel.yaml, which keeps comments, changed 1,554 lines of 75 experiments by reading and writing them alone
(quoted words folded, braces dropped).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import yaml


class Text(str):
    """A scalar with its place and its anchor; `raw` is what the file has there, empty where it is folded."""

    start: int = 0
    end: int = 0
    raw: str = ""
    anchor: str = ""


class Block(dict[Any, Any]):
    """A mapping with its place, its anchor, and whether it stands in braces."""

    start: int = 0
    end: int = 0
    flow: bool = False
    anchor: str = ""


class Items(list[Any]):
    """A list with its place, its anchor, and whether it stands in brackets."""

    start: int = 0
    end: int = 0
    flow: bool = False
    anchor: str = ""


@dataclass
class Alias:
    """What stands for an anchored node."""

    name: str
    target: Any
    start: int
    end: int


@dataclass
class _Reader:
    text: str
    events: list[Any]
    place: int = 0
    anchors: dict[str, Any] = field(default_factory=dict)
    scalars: list[tuple[int, int]] = field(default_factory=list)

    def node(self) -> Any:
        event = self.events[self.place]
        self.place += 1
        if isinstance(event, yaml.AliasEvent):
            return Alias(event.anchor, self.anchors[event.anchor], event.start_mark.index, event.end_mark.index)
        if isinstance(event, yaml.ScalarEvent):
            return self._scalar(event)
        new: Any = Block() if isinstance(event, yaml.MappingStartEvent) else Items()
        new.start, new.flow, new.anchor = event.start_mark.index, bool(event.flow_style), event.anchor or ""
        if event.anchor:
            self.anchors[event.anchor] = new
        new.end = event.end_mark.index
        while not isinstance(self.events[self.place], yaml.MappingEndEvent | yaml.SequenceEndEvent):
            if isinstance(new, Block):
                key = self.node()
                new[key] = self.node()
                last = new[key] if new[key] is not None else key
            else:
                new.append(last := self.node())
            new.end = max(new.end, getattr(last, "end", 0))
        if new.flow:
            new.end = self.events[self.place].end_mark.index
        self.place += 1
        return new

    def _scalar(self, event: Any) -> Any:
        start, end = event.start_mark.index, event.end_mark.index
        raw = self.text[start:end]
        if event.style in ("|", ">"):
            end = start + len(raw.rstrip())
        self.scalars.append((start, end))
        if event.implicit[0] and event.style is None and event.value in ("", "~", "null"):
            return None
        found = Text(event.value)
        found.start, found.end, found.raw = start, end, raw if event.style not in ("|", ">") else ""
        if event.anchor:
            found.anchor = event.anchor
            self.anchors[event.anchor] = found
        return found


def nodes_of(text: str) -> tuple[Any, list[tuple[int, int]]]:
    """Return the document of a text, and where its scalars begin and end."""
    reader = _Reader(text, list(yaml.parse(text, Loader=yaml.SafeLoader)))
    reader.place = 2  # the starts of stream and document
    if isinstance(reader.events[2], yaml.DocumentEndEvent | yaml.StreamEndEvent):
        return None, []
    return reader.node(), reader.scalars
