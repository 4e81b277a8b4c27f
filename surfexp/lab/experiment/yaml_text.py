"""Entries of a YAML document as text: in one line where that fits, else each below the other."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Mapping
from typing import Any

import yaml

from surfexp.lab.experiment.yaml_nodes import Alias, Text

WIDTH = 120
MERGED = "<<"
IN_BRACES = re.compile(r"[,\[\]{}]|: |^[-?:]( |$)|^[!&*|>%@`'\"#]| #")


def in_one_line(value: Any) -> str:
    """Return a value in braces, brackets or as it is."""
    if isinstance(value, Alias):
        return f"*{value.name}"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{in_one_line(key)}: {in_one_line(item)}" for key, item in value.items())
        return f"{anchor_of(value)}{{{inner}}}"
    if isinstance(value, list | tuple):
        return f"{anchor_of(value)}[{', '.join(map(in_one_line, value))}]"
    return _scalar(value)


def below(value: Any, indent: int) -> list[str]:
    """Return the lines of a mapping or a list whose entries stand below each other, without its anchor."""
    space = " " * indent
    lines: list[str] = []
    if isinstance(value, Mapping):
        for key, item in value.items():
            lines += entry(f"{space}{in_one_line(key)}:", item, indent)
    else:
        for item in value:
            line = f"{space}- {in_one_line(item)}"
            if len(line) <= WIDTH or not isinstance(item, Mapping | list):
                lines.append(line)
                continue
            inner = below(item, indent + 2)
            if anchor := anchor_of(item).strip():
                lines += [f"{space}- {anchor}", *inner]
            else:
                lines += [f"{space}- {inner[0].lstrip()}", *inner[1:]]
    return lines


def entry(head: str, value: Any, indent: int) -> list[str]:
    """Return the lines of one entry of a mapping, behind `KEY:`."""
    line = f"{head} {in_block(value)}"
    if len(line) <= WIDTH:
        return [line]
    if isinstance(value, Mapping | list) and value:
        return [f"{head} {anchor_of(value)}".rstrip(), *below(value, indent + 2)]
    if isinstance(value, str):
        return [
            f"{head} {anchor_of(value)}>-",
            *textwrap.wrap(
                value,
                WIDTH,
                initial_indent=" " * (indent + 2),
                subsequent_indent=" " * (indent + 2),
                break_long_words=False,
                break_on_hyphens=False,
            ),
        ]
    return [line]


def in_block(value: Any) -> str:
    """Return a value behind a key that stands on a line of its own; plain words may hold commas there."""
    if isinstance(value, Text) and value.raw and "\n" not in value.raw:
        return value.raw
    if isinstance(value, str) and _is_plain(value):
        return value
    return in_one_line(value)


def anchor_of(value: Any) -> str:
    """Return "&NAME " of an anchored value."""
    return f"&{name} " if (name := getattr(value, "anchor", "")) else ""


def _is_plain(value: str) -> bool:
    try:
        return "\n" not in value and yaml.safe_load(f"a: {value}") == {"a": value}
    except yaml.YAMLError:
        return False


def _scalar(value: Any) -> str:
    if isinstance(value, Text) and value.raw and "\n" not in value.raw:
        quoted = value.raw[0] in "'\""
        return value.raw if quoted or not IN_BRACES.search(value.raw) else json.dumps(str(value), ensure_ascii=False)
    if value == MERGED:
        return MERGED
    if isinstance(value, str):
        safe = _is_plain(value) and not IN_BRACES.search(value)
        return value if safe else json.dumps(value, ensure_ascii=False)
    return "null" if value is None else json.dumps(value)
