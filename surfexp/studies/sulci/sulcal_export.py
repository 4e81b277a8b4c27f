"""Named sulci of a surface as files for the usual tools, and tables of lengths as CSV."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.io.csv_cells import cell, cells
from surfexp.io.label_files import write_labels
from surfexp.io.writing import write_mesh
from surfexp.mesh.surface import Surface
from surfexp.studies.sulci.sulcal_measurement import NamedSulci

UNKNOWN = "unknown"


def sulcus_names(count: int) -> tuple[str, ...]:
    """Names of labels: 0 is unknown, then the template's regions from 1, the largest first."""
    return (UNKNOWN, *(f"region {k}" for k in range(1, count + 1)))


def export_sulci(folder: Path | str, name: str, surface: Surface, named: NamedSulci, count: int) -> tuple[Path, ...]:
    """Write the own regions of a surface under the template's names as NAME.label.gii, NAME.annot and NAME.vtk.

    Parameters
    ----------
    folder : path
        Made when it is not there.
    name : str
        Of the files; characters that file names do not have become "_".
    count : int
        Number of the template's regions.

    Returns
    -------
    tuple of Path
        The files. Both label files hold 0 for unknown, the .vtk the maps "own_region" and "carried_region".
    """
    folder, stem = Path(folder), re.sub(r"[^\w.-]+", "_", name)
    folder.mkdir(parents=True, exist_ok=True)
    files = tuple(folder / f"{stem}{suffix}" for suffix in (".label.gii", ".annot", ".vtk"))
    for path in files[:2]:
        write_labels(path, named.own + 1, sulcus_names(count))
    maps = {"own region": (named.own + 1).astype(np.float64), "carried region": (named.carried + 1).astype(np.float64)}
    write_mesh(files[2], surface.mesh, maps)
    return files


def write_length_table(path: Path | str, rows: Sequence[str], columns: Mapping[str, Floats]) -> None:
    """Write a table of lengths as CSV: the row's name, then the columns; empty where no length was found."""
    with Path(path).open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(["row", *cells(columns)])
        for row, *values in zip(rows, *columns.values(), strict=True):
            writer.writerow([cell(row), *(f"{value:.6g}" if np.isfinite(value) else "" for value in values)])
