"""One writer for each class of results; what has none is written as its arrays and metrics."""

from __future__ import annotations

import csv
import dataclasses
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import singledispatch
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import issparse

from surfexp.commands.exporting.folder import ExportFolder
from surfexp.contract.arrays import Floats
from surfexp.io.csv_cells import cells
from surfexp.mesh.surface import Surface


@dataclass
class Place:
    """Where the files of one result go, and what they need beside it.

    Parameters
    ----------
    folder : ExportFolder
    stem : str
        How their names begin.
    surface : Surface, optional
        On whose vertices the result lives.
    carried : dict of str to (n,) or (n, c) array
        Maps of other results, where the result is their surface.
    picture : Path, optional
        The finished picture, where the result is a figure and its report was written.
    matrix_market : bool
        Whether matrices are written as .mtx too.
    for_print : bool
        Whether plots are written as .pdf and at 300 dots an inch too.
    files : list of Path
        What was written.
    """

    folder: ExportFolder
    stem: str
    surface: Surface | None = None
    carried: Mapping[str, Floats] = field(default_factory=dict)
    picture: Path | None = None
    matrix_market: bool = False
    for_print: bool = False
    files: list[Path] = field(default_factory=list)

    def file(self, suffix: str, stem: str = "") -> Path:
        """Return the path of the next file: its suffix, with what comes before it after a dash ("-history.csv")."""
        self.files.append(self.folder.claim(stem or self.stem, suffix))
        return self.files[-1]


@singledispatch
def write(result: Any, place: Place) -> None:
    """Write a result; of a class that nothing is known of, its arrays as .npz and its metrics as .csv."""
    arrays = arrays_of(result)
    if arrays:
        write_arrays(place.file(".npz"), arrays)
    write_metrics(place.file(".csv"), getattr(result, "metrics", {}))


@singledispatch
def maps_of(result: Any) -> dict[str, Floats]:
    """Return the maps that a result consists of, by what follows its own name ("" is the result itself)."""
    return {}


def arrays_of(value: Any, path: str = "") -> dict[str, Any]:
    """Return all arrays inside a result by their path; a sparse matrix is data, indices, indptr and shape."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        inside: Iterable[tuple[Any, Any]] = [
            (item.name, getattr(value, item.name)) for item in dataclasses.fields(value)
        ]
    elif isinstance(value, Mapping):
        inside = value.items()
    elif isinstance(value, list | tuple):
        inside = enumerate(value)
    elif issparse(value):
        matrix = value.tocsr()
        parts = {
            "data": matrix.data,
            "indices": matrix.indices,
            "indptr": matrix.indptr,
            "shape": np.array(matrix.shape),
        }
        inside = parts.items()
    else:
        return {path: value} if isinstance(value, np.ndarray) and value.dtype.kind in "fiub" else {}
    found: dict[str, Any] = {}
    for name, part in inside:
        step = re.sub(r"[^\w-]+", "_", str(name))
        found |= arrays_of(part, f"{path}.{step}" if path else step)
    return found


def write_arrays(path: Path, arrays: Mapping[str, Any]) -> None:
    """Write named arrays as .npz; numbers only, so that reading it never runs anything."""
    named: dict[str, Any] = {name: np.asarray(array) for name, array in arrays.items()}
    np.savez_compressed(path, allow_pickle=False, **named)


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """Write a table: numbers with all their digits, NaN as an empty cell."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(cells(header))
        writer.writerows(cells(map(_cell, row)) for row in rows)


def write_metrics(path: Path, metrics: Mapping[str, float]) -> None:
    """Write the numbers of a result, one a row."""
    write_csv(path, ("metric", "value"), metrics.items())


def _cell(value: Any) -> Any:
    if isinstance(value, str | bool | np.bool_ | int | np.integer):
        return value
    number = float(value)
    if math.isnan(number):
        return ""
    return int(number) if number.is_integer() and abs(number) < 1e15 else repr(number)
