"""Datasets of one's own surfaces: the items of a folder, a pattern of paths, or a table of paths and facts."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from surfexp.io.csv_cells import separator_of
from surfexp.io.mesh_patterns import MESH_PATTERNS, files_called
from surfexp.lab.errors import UserError

# maps among GIFTI files are refused with the reason when they are read
PATTERNS = (*MESH_PATTERNS, "*.gii", "*.mat")
CLASS_OF_NAME = r"(?P<class>[^/\d]*[^/\d_. -])[^/]*$"
TABLES = (".csv", ".tsv")
DATASET = "shapes"
COLUMNS = ("path", "class", "group", "level", "label")
PATTERN_MARKS = "*?["
Item = dict[str, Any]


def is_of_files(name: str) -> bool:
    """Whether the name of a dataset is that of a folder or a table, or a pattern of paths."""
    if any(mark in name for mark in PATTERN_MARKS) or Path(name).suffix.lower() in TABLES:
        return True
    try:
        return Path(name).is_dir()
    except OSError:  # longer than a name can be
        return False


def name_of_dataset(source: Path) -> str:
    """Return the name of a table without its suffix, or of the folder that is named or stands before a pattern."""
    if any(mark in str(source) for mark in PATTERN_MARKS):
        source = _parted(source)[0]
    return source.stem if source.is_file() else source.resolve().name


def items_of_files(
    source: Path, patterns: Sequence[str] = PATTERNS, group: str = CLASS_OF_NAME, plugin: str = "file"
) -> list[Item]:
    """Return the items of a dataset, each with its label; no surface is read.

    Parameters
    ----------
    source : Path
        A folder; a table (`.csv`, `.tsv`) with the column `path`, from the table's own folder, and if wanted `class`,
        `group`, `level`, `label`, and `surface.OPTION` for options of the plugin; or a pattern such as `shapes/*.off`.
    patterns : sequence of str
        Of the files of a folder.
    group : str
        Regular expression of the files' paths with (?P<class>...) and, if wanted, (?P<owner>...), (?P<detail>...); a table
        needs none.
    plugin : str
        That reads a path.

    Raises
    ------
    UserError
        If there is no file, a table lacks the column, an expression finds no class, or two items have one label.
    """
    if source.suffix.lower() in TABLES:
        return _unlike(_rows(source, plugin))
    if source.is_dir():
        files = files_called(source, patterns)
        nothing = f"no file in {str(source)!r} is called {' or '.join(patterns)}; set --pattern"
    elif any(mark in str(source) for mark in PATTERN_MARKS):
        source, pattern = _parted(source)
        files = list(source.glob(pattern))
        nothing = f"no file in {str(source)!r} is called {pattern}"
    else:
        raise UserError(f"folder {str(source)!r} does not exist")
    files = sorted({file.resolve() for file in files if file.is_file()}, key=_natural)
    if not files:
        raise UserError(nothing)
    return _unlike(_item(file, source.resolve(), group, plugin) for file in files)


def _parted(pattern: Path) -> tuple[Path, str]:
    """The folder in front of the first part of a path that is a pattern, and the rest."""
    first = next(place for place, part in enumerate(pattern.parts) if any(mark in part for mark in PATTERN_MARKS))
    return Path(*pattern.parts[:first]), str(Path(*pattern.parts[first:]))


def _natural(file: Path) -> list[Any]:
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", str(file))]


def _item(file: Path, folder: Path, group: str, plugin: str) -> Item:
    try:
        pattern = re.compile(group)
    except re.error as error:
        raise UserError(f"--group {group!r} is no regular expression: {error}") from None
    whole = file.relative_to(folder) if file.is_relative_to(folder) else Path(file.name)
    place = whole.with_suffix("").as_posix()
    found = pattern.search(place) or pattern.search(whole.as_posix())
    named = found.groupdict() if found else {}
    if not named.get("class"):
        raise UserError(f"--group {group!r} finds no class in {place!r}; write (?P<class>...) around it")
    owner = named.get("owner") or file.stem
    label = " ".join(filter(None, [named["class"], owner, named.get("detail")]))
    surface = {"name": plugin, "path": str(file)}
    return {"label": label, "class": named["class"], "group": owner, "surface": surface}


def _rows(table: Path, plugin: str) -> Iterable[Item]:
    rows = _reader(table)
    try:
        columns = _columns(rows)
        wrong = "has no column 'path'" if "path" not in columns else _wrong_column(columns)
        if wrong:
            raise UserError(f"table {str(table)!r} {wrong}; its columns are {', '.join(columns) or 'none'}")
        for cells in rows:
            if not any(cells):
                continue
            named = {name: cell.strip() for name, cell in zip(columns, cells, strict=False) if name and cell.strip()}
            if "path" not in named or len(cells) > len(columns):
                wrong = "there is no path" if "path" not in named else f"{len(cells)} cells for {len(columns)} columns"
                raise UserError(f"table {str(table)!r}, line {rows.line_num}: {wrong}")
            yield _described(named, table.resolve().parent, plugin)
    except csv.Error as error:
        raise UserError(f"table {str(table)!r}, line {rows.line_num}: {error}") from None


def _wrong_column(columns: Sequence[str]) -> str:
    twice = [name for name in dict.fromkeys(columns) if name and columns.count(name) > 1]
    own = [name for name in columns if name in ("surface.path", "surface.name")]
    return f"has the column {twice[0]!r} twice" if twice else f"has the column {own[0]!r}, write path" if own else ""


def _described(cells: Mapping[str, str], folder: Path, plugin: str) -> Item:
    path = (folder / cells["path"]).resolve()
    facts: Item = {"group": path.stem} | {name: cells[name] for name in ("class", "group") if name in cells}
    if "level" in cells:
        facts["level"] = _number(cells["level"], path)
    options = {name.removeprefix("surface."): value for name, value in cells.items() if name.startswith("surface.")}
    label = cells.get("label") or " ".join(filter(None, [cells.get("class"), path.stem]))
    return {"label": label, **facts, "surface": {"name": plugin, "path": str(path), **options}}


def _number(text: str, path: Path) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise UserError(f"the level of {path.name} is {text!r}: write a finite number")
    return number


def unused_columns(table: Path) -> list[str]:
    """Return the names of a table's columns that say nothing of an item."""
    return [name for name in _columns(_reader(table)) if name not in COLUMNS and not name.startswith("surface.")]


def _reader(table: Path) -> Any:
    try:
        text = table.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"table {str(table)!r} cannot be read: {' '.join(str(error).split())}") from None
    return csv.reader(io.StringIO(text, newline=""), delimiter=separator_of(text.splitlines()), strict=True)


def _columns(rows: Any) -> list[str]:
    return [name.strip() for name in next(rows, [])]


def _unlike(items: Iterable[Item]) -> list[Item]:
    found: dict[str, Item] = {}
    for item in items:
        if item["label"] in found:
            names = " and ".join(Path(one["surface"]["path"]).name for one in (found[item["label"]], item))
            raise UserError(
                f"two files are called {item['label']!r}, {names}; tell them apart by (?P<owner>...) or (?P<detail>...), "
                "or by the column label of a table"
            )
        found[item["label"]] = item
    if not found:
        raise UserError("the table has no row")
    return list(found.values())
