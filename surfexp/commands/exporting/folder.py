"""The folder of an export: files appear in it whole and all at once, beside an index, and nobody else's are touched."""

from __future__ import annotations

import csv
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from surfexp.io.csv_cells import cell, cells
from surfexp.lab.errors import UserError

INDEX = "index.csv"
FIRST = ("file", "kind", "plugin", "comparison", "label")


class ExportFolder:
    """Files are written beside each other in a hidden folder, and moved to their places by `publish`.

    Parameters
    ----------
    folder : Path
        Made when it is not there.

    Raises
    ------
    UserError
        If it is a file, or has an index.csv that is not of an export.
    """

    def __init__(self, folder: Path) -> None:
        if folder.exists() and not folder.is_dir():
            raise UserError(f"{folder} is a file; choose a folder with --to")
        self.folder, self.rows = folder, _read_index(folder / INDEX)
        self.taken = {INDEX}

    def __enter__(self) -> ExportFolder:
        self.made = not self.folder.exists()
        self.folder.mkdir(parents=True, exist_ok=True)
        self.staging = Path(tempfile.mkdtemp(prefix=".surfexp-", dir=self.folder))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        shutil.rmtree(self.staging, ignore_errors=True)
        if self.made and not any(self.folder.iterdir()):
            self.folder.rmdir()

    def claim(self, stem: str, suffix: str) -> Path:
        """Return where to write a file, numbered where this export has the name already.

        Raises
        ------
        UserError
            If there is a file of this name that no earlier export has written.
        """
        name, number = f"{stem}{suffix}", 1
        while name in self.taken:
            number += 1
            name = f"{stem}-{number}{suffix}"
        for one in (name, certificate_of(name)):
            present = self.folder / one
            if name not in self.rows and (present.exists() or present.is_symlink()):
                raise UserError(
                    f"{present} is not of an earlier export: move it away, or choose another folder with --to"
                )
        self.taken |= {name, certificate_of(name)}
        return self.staging / name

    def drop(self, files: Iterable[Path]) -> None:
        """Forget files that are written in part or not at all."""
        for file in files:
            file.unlink(missing_ok=True)
            self.taken -= {file.name, certificate_of(file.name)}

    def publish(self, rows: Iterable[Mapping[str, Any]]) -> list[Path]:
        """Move all files to their places and write the index, in which earlier ones stay; return the files.

        The index comes first: an export that is interrupted here can be made again over what it has left.
        """
        files = sorted(self.staging.iterdir())
        earlier = [row for name, row in self.rows.items() if name not in self.taken and (self.folder / name).exists()]
        _write_index(self.folder / INDEX, [*rows, *earlier])
        for file in files:
            file.replace(self.folder / file.name)
        return [self.folder / file.name for file in files]


def certificate_of(name: str) -> str:
    """Name of the certificate beside a file."""
    return f"{name}.json"


def _read_index(path: Path) -> dict[str, dict[str, Any]]:
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8", errors="replace") as stream:
        reader = csv.DictReader(stream)
        if tuple(reader.fieldnames or ())[: len(FIRST)] != FIRST:
            raise UserError(f"{path} is not the index of an export: move it away, or choose another folder with --to")
        return {row["file"]: {name: value for name, value in row.items() if name and value} for row in reader}


def _write_index(path: Path, rows: list[Mapping[str, Any]]) -> None:
    """A row a file; a column a parameter that differs (it has a dot), the key, then a column a metric."""
    names = dict.fromkeys(name for row in rows for name in row if name not in (*FIRST, "key"))
    parameters = [name for name in names if "." in name]
    columns = [*FIRST, *parameters, "key", *(name for name in names if "." not in name)]
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, columns, restval="", lineterminator="\n")
        writer.writerow(dict(zip(columns, cells(columns), strict=True)))
        for row in sorted(rows, key=lambda row: str(row["file"])):
            writer.writerow({name: cell(value) for name, value in row.items()})
