"""numpy's archives (.npz) and arrays (.npy): named arrays, never pickled objects."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfexp.io.foreign import parsing
from surfexp.io.unpacked_sizes import check_arrays

HEMISPHERE, SIDES = "hemisphere", ("left", "right")
# what makes an archive one of a surface, and how the names of its parts that are no maps begin
MESH, OWN = ("vertices", "faces"), "surface."


def read_arrays(path: Path) -> dict[str, NDArray[np.generic]]:
    """Return the arrays of an archive by name, or the one array of a .npy under the name "map".

    Raises
    ------
    ValueError
        If the file is broken or holds objects.
    """
    check_arrays(path)
    with parsing("array file"):
        loaded = np.load(path, allow_pickle=False)
    if isinstance(loaded, np.ndarray):
        return {"map": loaded}
    if path.suffix == ".npy":
        raise ValueError("it is an archive of several arrays: name it .npz")
    with parsing("array file"), loaded:
        return {name: loaded[name] for name in loaded.files}


def read_rows(path: Path, hemisphere: str = "") -> dict[str, NDArray[np.generic]]:
    """Return the arrays of an archive without what says the hemisphere; where it is said of each row, the rows of one.

    Of the archive of a surface these are its maps.

    Parameters
    ----------
    path : Path
    hemisphere : {"", "left", "right"}
        Without it all rows.

    Raises
    ------
    ValueError
        As `read_arrays`, or if a row is of another side than left and right.
    """
    arrays = read_arrays(path)
    if set(MESH) <= set(arrays):
        arrays = {name: array for name, array in arrays.items() if name not in MESH and not name.startswith(OWN)}
    if HEMISPHERE not in arrays or arrays[HEMISPHERE].dtype.kind != "U":
        return arrays
    said = arrays.pop(HEMISPHERE)
    if said.ndim and not np.isin(said, SIDES).all():
        raise ValueError(
            f"array {HEMISPHERE!r} has {str(said[~np.isin(said, SIDES)][0])!r}: 'left' and 'right' are known"
        )
    if not hemisphere or not said.ndim:
        return arrays
    rows = said == hemisphere
    return {name: array[rows] if array.shape[:1] == said.shape else array for name, array in arrays.items()}


def says_sides(path: Path) -> bool:
    """Whether an archive says the hemisphere of each row.

    Raises
    ------
    ValueError
        As `read_arrays`.
    """
    said = read_arrays(path).get(HEMISPHERE)
    return said is not None and said.dtype.kind == "U" and said.ndim == 1


def hemisphere_of_npz(path: Path) -> str:
    """Return "left" or "right" where the array "hemisphere" says so, else nothing.

    Raises
    ------
    ValueError
        As `read_arrays`.
    """
    found = read_arrays(path).get(HEMISPHERE)
    return str(found) if found is not None and found.dtype.kind == "U" and str(found) in SIDES else ""


def write_arrays(
    path: Path, arrays: Mapping[str, NDArray[np.generic]], hemisphere: str | NDArray[np.str_] = ""
) -> None:
    """Write arrays under their names, and the hemisphere, or that of each row, as the array of that name.

    Whole numbers and words are compressed. Floating-point numbers are not: of 50 eigenfunctions zlib saves a tenth, for a
    quarter of the time of computing them.

    Raises
    ------
    ValueError
        If an array has that name, or one that ends in .npy.
    """
    if len(hemisphere) and HEMISPHERE in arrays:
        raise ValueError(f"a map is called {HEMISPHERE!r}, the name of what says left or right: rename it")
    kept = {**arrays, **({HEMISPHERE: np.array(hemisphere)} if len(hemisphere) else {})}
    if reserved := [name for name in kept if name.endswith(".npy")]:
        raise ValueError(f"map name {reserved[0]!r} ends as the files in an archive do: rename the map")
    # numpy's own function has parameters that could be names of maps
    with zipfile.ZipFile(path, "w") as archive:
        for name, array in kept.items():
            file = zipfile.ZipInfo(f"{name}.npy")
            file.compress_type = zipfile.ZIP_STORED if np.asanyarray(array).dtype.kind in "fc" else zipfile.ZIP_DEFLATED
            with archive.open(file, "w", force_zip64=True) as member:
                np.lib.format.write_array(member, np.asanyarray(array), allow_pickle=False)
