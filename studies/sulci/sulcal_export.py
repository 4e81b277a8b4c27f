"""Named sulci of a surface as files for the usual tools."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from surfexp.contract.member import Member
from surfexp.io.label_files import write_labels
from surfexp.io.writing import write_mesh
from surfexp.mesh.surface import Surface

from .sulcal_measurement import NamedSulci, name_sulci
from .sulcal_template import make_template

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
        write_labels(path, named.own + 1, sulcus_names(count), surface.hemisphere)
    maps = {"own region": (named.own + 1).astype(np.float64), "carried region": (named.carried + 1).astype(np.float64)}
    write_mesh(files[2], surface.mesh, maps)
    return files


def exported_sulci(
    folder: Path, template: Surface, surfaces: Mapping[Member, Surface], *, regions: int
) -> Iterator[tuple[str, Path]]:
    """Write the named sulci of every surface of a table of lengths.

    Parameters
    ----------
    folder : Path
    template : Surface
    surfaces : mapping of Member to Surface
    regions : int
        That are measured.

    Yields
    ------
    tuple of str and Path
        The label of the surface and a file: .label.gii, .annot or .vtk.
    """
    study = make_template(template, regions)
    for number, (member, surface) in enumerate(surfaces.items()):
        named = name_sulci(study, surface)
        for file in export_sulci(folder / str(number), "sulci", surface, named, int(study.regions.max()) + 1):
            yield member.label, file
