"""Spectra of many structures as one table, in the layout of BrainPrint."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.anatomy.aseg import LabelledStructure, read_label_volume, structure_surface
from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.anatomy.label_volume import LabelVolume
from surfexp.contract.arrays import Floats
from surfexp.contract.summary import Summarized, Summary
from surfexp.io.csv_cells import cells
from surfexp.io.replacing import replacing
from surfexp.mesh.given_numbers import real_number, whole_number
from surfexp.mesh.surface import Surface
from surfexp.spectrum.lowest_pairs import lowest_pairs
from surfexp.tasks.files import read
from surfexp.tasks.fingerprint_sources import structures
from surfexp.tasks.part_of_task import part_for
from surfexp.tasks.surface_file import PathLike

# the file, how many are done, how many there are
Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False, repr=False)
class Fingerprints(Summarized):
    """Area, volume and lowest eigenvalues of structures, with their proof.

    Parameters
    ----------
    columns : dict of str to (2 + k,) float64
        For each structure its area, its volume (NaN where it is open) and its eigenvalues ev0, ev1, ...
    residuals : dict of str to float
        Largest relative residual.
    complete : dict of str to bool
    repairs : dict of str to tuple of str
        What was repaired, one sentence each.
    refused : dict of str to str
        What was left out, and why.
    """

    columns: dict[str, Floats]
    residuals: dict[str, float]
    complete: dict[str, bool]
    repairs: dict[str, tuple[str, ...]] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)

    @property
    def notes(self) -> tuple[str, ...]:
        """What was repaired and what was left out, one sentence each."""
        said = [f"{name}: {change}" for name, changes in self.repairs.items() for change in changes]
        return tuple(said + [f"left out: {name}: {reason}" for name, reason in self.refused.items()])

    def rows(self) -> dict[str, list[Any]]:
        """Return the table by rows.

        Returns
        -------
        dict of str to list
            area, volume, ev0, ev1, ..., residual, complete (1 or 0) and repairs (their number), one entry a structure.
        """
        count = len(next(iter(self.columns.values()), np.empty(2))) - 2
        names = ["area", "volume", *(f"ev{k}" for k in range(count))]
        rows: dict[str, list[Any]] = {
            name: [float(column[k]) for column in self.columns.values()] for k, name in enumerate(names)
        }
        rows["residual"] = [self.residuals[name] for name in self.columns]
        rows["complete"] = [int(self.complete[name]) for name in self.columns]
        rows["repairs"] = [len(self.repairs.get(name, ())) for name in self.columns]
        return rows

    def _summary(self) -> Summary:
        facts = {
            "complete": sum(self.complete.values()),
            "largest residual": max(self.residuals.values(), default=None),
            "repaired": len(self.repairs),
            "left out": len(self.refused),
        }
        return Summary(f"fingerprints of {len(self.columns)} structures", facts, self.notes)

    def save(self, path: PathLike) -> None:
        """Write one CSV: a column a structure, rows as in BrainPrint, then those of the proof.

        Parameters
        ----------
        path : path
        """
        with replacing(Path(path)) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(["", *cells(self.columns)])
            for name, values in self.rows().items():
                writer.writerow([name, *("" if value != value else repr(value) for value in values)])


def fingerprint(
    sources: PathLike | Sequence[PathLike],
    count: int = 50,
    *,
    repair: bool = True,
    tolerance: float = 1e-8,
    progress: Progress | None = None,
) -> Fingerprints:
    """Return area, volume and the lowest eigenvalues of every surface of some files, a folder or a SUBJECTS_DIR.

    Parameters
    ----------
    sources : path, or list of paths
        Surface files; FreeSurfer subjects or folders of them, of which surf/{lh,rh}.{white,pial} are taken, called
        lh-white-2d and so on as in BrainPrint, and the structures in mri/aseg.mgz as closed surfaces; other folders, of
        which every surface file is taken, and the structures in ``*_desc-aseg_dseg.nii.gz`` of BIDS derivatives. A file
        of both hemispheres has a column for each.
    count : int
        How many eigenvalues, ev0 = 0 among them.
    repair : bool
        Repair defective meshes, with a note, in place of leaving them out.
    tolerance : float
        Largest relative residual.
    progress : callable, optional
        Receives the name, how many are done, and how many there are.

    Returns
    -------
    Fingerprints
        `columns`, `residuals`, `complete`, `repairs`, `refused`; `save(path)` writes the CSV.

    Raises
    ------
    ValueError
        If there is no surface at all, or the number of eigenvalues is not positive.

    References
    ----------
    Wachinger, Golland, Kremen, Fischl, Reuter: BrainPrint: a discriminative characterization of brain morphology (2015).

    Examples
    --------
    >>> import surfexp as sx
    >>> sx.write("ball.ply", sx.shape("icosphere", levels=3))
    >>> table = sx.fingerprint(["ball.ply"], count=4)
    >>> table.columns["ball"].round(1).tolist(), table.complete["ball"]
    ([12.5, 4.2, 0.0, 2.0, 2.0, 2.0], True)
    """
    count = whole_number(count, "count", 1)
    tolerance = real_number(tolerance, "tolerance", above=0.0, below=1.0)
    given = [sources] if isinstance(sources, str) or not isinstance(sources, Iterable) else list(sources)
    found = structures(given)
    table = Fingerprints({}, {}, {})
    volume_of = lru_cache(maxsize=1)(read_label_volume)
    for done, (name, source) in enumerate(found.items()):
        if progress is not None:
            progress(name, done, len(found))
        with _or_left_out(table, name):
            surface = read(source, repair=repair) if isinstance(source, Path) else _closed(source, volume_of)
            for column, side in _columns(name, surface).items():
                with _or_left_out(table, column):
                    _measure(table, column, side, count, tolerance)
    return table


@contextmanager
def _or_left_out(table: Fingerprints, name: str) -> Iterator[None]:
    """Note why a column cannot be made, and go on."""
    try:
        yield
    except (ValueError, OSError) as error:
        table.refused[name] = " ".join(str(error).split())


def _columns(name: str, surface: Surface) -> dict[str, Surface]:
    """The surface of each column: two where one file is both hemispheres."""
    if surface.right is None:
        return {name: surface}
    return {f"{name} {side}": one for side, one in surface.hemispheres().items()}


def _closed(structure: LabelledStructure, volume_of: Callable[[Path], LabelVolume]) -> Surface:
    return structure_surface(volume_of(structure.file), structure.name)


def _measure(table: Fingerprints, name: str, surface: Surface, count: int, tolerance: float) -> None:
    part = part_for(surface)
    operator, system = lowest_pairs(Surface(part.mesh, name), count, tolerance=tolerance)
    system = system.in_length(part.length)
    volume = enclosed_volume(part.mesh) * part.length**3 if part.mesh.is_closed else np.nan
    # rounding leaves the zero mode a little off
    values = np.where(np.abs(system.values) < 1e-9 * system.spacing, 0.0, system.values)
    table.columns[name] = np.concatenate([[part.mesh.area * part.length**2, volume], values])
    table.residuals[name] = float(system.residuals.max())
    table.complete[name] = system.complete
    if notes := (*surface.notes, *operator.notes):
        table.repairs[name] = notes
