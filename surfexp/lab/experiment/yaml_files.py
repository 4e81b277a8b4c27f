"""YAML files of people, read with a line for every mistake: nothing is taken twice, nothing unfolds without end.

ruamel.yaml has lines and refuses repeated keys too, but lets an alias stand inside of itself and bounds no aliases, so
that the check below would stay.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from surfexp.lab.errors import UserError

# entries with all aliases written out; the longest experiment has some 700
LARGEST = 100_000
# all but tabulators and ends of lines
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")


def read_yaml(file: Path) -> dict[str, Any]:
    """Return the mapping that a file holds.

    Raises
    ------
    UserError
        If it is no UTF-8, no YAML or no mapping, has a key twice, a text with control codes, or aliases that unfold to over
        100,000 entries; with the line where that is.
    """
    import yaml

    try:
        text = file.read_text(encoding="utf-8")
        node = yaml.compose(text, Loader=yaml.SafeLoader)
        if node is not None:
            _check(node, file, {}, ())
        found = yaml.safe_load(text)
    except UnicodeDecodeError as error:
        raise UserError(f"{file}: byte {error.start} is no UTF-8; save the file as UTF-8") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f", line {mark.line + 1}" if mark else ""
        raise UserError(f"{file}{where}: not YAML: {_line(error.problem or error.context or '')}") from None
    except yaml.YAMLError as error:
        raise UserError(f"{file}: {_line(str(error).splitlines()[0])}") from None
    except RecursionError:
        raise UserError(f"{file}: its entries lie too deep in one another") from None
    if not isinstance(found, dict):
        raise UserError(
            f"{file} holds {type(found).__name__}, a mapping of options is needed: NAME: VALUE in each line"
        )
    return found


def check_variants(configuration: Mapping[str, Any]) -> None:
    """Refuse `variants` that are no list of mappings, and a `grid` that is no mapping of lists; UserError with the place."""
    variants = configuration.get("variants") or []
    if not isinstance(variants, list):
        raise UserError(f"variants is {_shown(variants)}, a list of partial configurations is needed")
    for number, variant in enumerate(variants, 1):
        if not isinstance(variant, Mapping):
            raise UserError(f"variant {number} is {_shown(variant)}, a partial configuration is needed: OPTION: VALUE")
    for number, given in enumerate([configuration, *variants]):
        where = f"grid of variant {number}" if number else "grid"
        grid = given.get("grid") or {}
        if not isinstance(grid, Mapping):
            raise UserError(f"{where} is {_shown(grid)}, options with lists of values are needed: OPTION: [VALUE, ...]")
        for option, values in grid.items():
            if not isinstance(values, list):
                raise UserError(f"{where}: {option} is {_shown(values)}, a list of values is needed")


def _shown(value: Any) -> str:
    return _line(repr(value))[:60]


def _line(text: str) -> str:
    return " ".join(text.split())[:160]


def _check(node: Any, file: Path, sizes: dict[int, int], above: tuple[int, ...]) -> int:
    """Return the entries of a node with its aliases written out; refuse what is inside itself and keys that repeat."""
    import yaml

    where = f"{file}, line {node.start_mark.line + 1}"
    if id(node) in above:
        raise UserError(f"{where}: an alias stands inside of what it is an alias of")
    if id(node) in sizes:
        return sizes[id(node)]
    size = 1
    if isinstance(node, yaml.MappingNode):
        seen: set[str] = set()
        for key in [key for key, _ in node.value if isinstance(key, yaml.ScalarNode)]:
            _check(key, file, sizes, (*above, id(node)))
            if key.value in seen:
                raise UserError(f"{file}, line {key.start_mark.line + 1}: key {_line(key.value)!r} stands there twice")
            seen.add(key.value)
        size += sum(_check(value, file, sizes, (*above, id(node))) for _, value in node.value)
    elif isinstance(node, yaml.SequenceNode):
        size += sum(_check(value, file, sizes, (*above, id(node))) for value in node.value)
    if isinstance(node, yaml.ScalarNode) and (codes := CONTROL.findall(node.value)):
        raise UserError(f"{where}: the text holds the control code {codes[0]!a}, which steers a terminal: remove it")
    if size > LARGEST:
        raise UserError(f"{where}: its aliases unfold to over {LARGEST:,} entries")
    sizes[id(node)] = size
    return size
