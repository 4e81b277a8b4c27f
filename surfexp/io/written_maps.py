"""Maps on a surface written to files: the format follows from the file's name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.io import freesurfer
from surfexp.io.cifti import is_cifti, write_cifti_maps
from surfexp.io.gifti import is_gifti, write_gifti_maps
from surfexp.io.hemisphere import check_named_side, holds_both
from surfexp.io.map_files import LABEL_FILES, TEXT, VOLUMES
from surfexp.io.map_names import check_map_names
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.npz import write_arrays
from surfexp.io.replacing import check_writable, replacing
from surfexp.io.single_precision import check_single_precision_maps
from surfexp.io.text_tables import check_column_names, write_table
from surfexp.io.writing import FREESURFER
from surfexp.mesh.surface import BOTH

CURVATURES = (".curv", ".sulc", ".thickness", ".area")
# lh.pial is a surface, lh.area.pial is a map
SHEETS = (*FREESURFER, ".smoothwm")
WRITABLE = (
    ".shape.gii, .func.gii, .dscalar.nii, .mgh, .mgz, .npy, .npz, .csv, .txt, or a FreeSurfer curvature file (lh.sulc)"
)
# names such as lh.thickness.fsaverage are FreeSurfer's own; these belong to others, or to what is no map
OTHERS = (
    ".annot",
    ".label",
    ".nii",
    ".gz",
    ".asc",
    ".mat",
    ".tsv",
    ".json",
    ".h5",
    ".hdf5",
    ".parquet",
    ".pkl",
    ".xlsx",
)
PICTURES_AND_MESHES = (
    ".png",
    ".jpg",
    ".svg",
    ".pdf",
    ".html",
    ".zip",
    ".vtu",
    ".obj",
    ".off",
    ".stl",
    ".ply",
    ".vtk",
    ".vtp",
)


def holds_names(path: Path | str) -> bool:
    """Whether a format of maps has room for several maps with their names."""
    path = Path(path)
    return path.suffix.lower() in (".npz", *TEXT) or is_cifti(path) or is_gifti(path)


def write_maps(path: Path | str, maps: dict[str, Floats], hemisphere: str | NDArray[np.str_] = "") -> None:
    """Write maps of one length as .shape.gii, .func.gii, .dscalar.nii, .mgh, .mgz, .npy, .npz, .csv, .txt, or as curvature.

    Of both hemispheres .dscalar.nii and .npz hold maps; `hemisphere` is then that of each vertex.

    Raises
    ------
    ValueError
        If the format is unknown, takes a single map, cannot say NaN where there is one, or has too small a range, or the file
        is named as the other hemisphere.
    """
    path = Path(path)
    channels = max((values.shape[1] for values in maps.values() if values.ndim == 2), default=1)
    check_map_target(path, len(maps), channels, hemisphere if isinstance(hemisphere, str) else BOTH)
    if not isinstance(hemisphere, str) and not holds_both(path):
        raise ValueError(f"{path} holds one hemisphere, the maps are of both: choose .dscalar.nii or .npz")
    check_names(path, maps)
    lengths = {len(values) for values in maps.values()}
    # an archive also holds results whose arrays are no maps
    if len(lengths) != 1 and path.suffix.lower() != ".npz":
        raise ValueError(f"{path}: maps have {sorted(lengths)} values, one for each vertex of one surface is needed")
    suffix = path.suffix.lower()
    with replacing(path) as temporary:
        if suffix == ".npz":
            write_arrays(temporary, maps, hemisphere)
        elif suffix in TEXT:
            write_table(temporary, scalar_channels(maps))
        elif is_cifti(path):
            write_cifti_maps(temporary, check_single_precision_maps(scalar_channels(maps)), hemisphere)
        elif is_gifti(path):
            write_gifti_maps(temporary, check_single_precision_maps(scalar_channels(maps)), str(hemisphere))
        elif suffix == ".npy":
            np.save(temporary, next(iter(maps.values())))
        elif suffix in VOLUMES:
            freesurfer.write_volume_map(temporary, next(iter(check_single_precision_maps(maps).values())))
        else:
            freesurfer.write_curvature(temporary, next(iter(check_single_precision_maps(maps).values())))


def check_names(path: Path | str, maps: dict[str, Floats]) -> None:
    """Refuse names of maps that a file of maps cannot give back, before anything is computed.

    Raises
    ------
    ValueError
        Naming the first of them.
    """
    check_map_names(maps)
    if Path(path).suffix.lower() in TEXT:
        check_column_names(Path(path), scalar_channels(maps))


def check_map_target(
    path: Path | str, count: int = 1, channels: int = 1, hemisphere: str | None = None, unknown: bool = False
) -> None:
    """Refuse a file that maps cannot be written to: of a format that is unknown or too narrow, or in no writable folder.

    Parameters
    ----------
    path : path
    count : int
        Number of maps.
    channels : int
        The most channels that one has.
    hemisphere : {"", "left", "right", "both"}, optional
        Of the maps; None if it is not known yet.
    unknown : bool
        Whether they are NaN somewhere.

    Raises
    ------
    ValueError
        Naming the formats that can hold them, or if the file is named as the other hemisphere.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if path.name.lower().endswith((*LABEL_FILES, ".label", ".surf.gii")):
        raise ValueError(
            f"{path} is named as a file of labels or of a surface, a map is none: choose one of {WRITABLE}"
        )
    cifti = path.name.lower().endswith(".dscalar.nii")
    known = suffix in (".npz", ".npy", *TEXT, *VOLUMES, *CURVATURES) or cifti or is_gifti(path)
    foreign = suffix in (*OTHERS, *PICTURES_AND_MESHES) or (path.name.count(".") == 1 and suffix in SHEETS)
    if not known and (foreign or not freesurfer.hemisphere_of(path)):
        raise ValueError(f"{path} has an unknown format of maps, choose one of {WRITABLE}")
    if count != 1 and not holds_names(path):
        raise ValueError(f"{path} holds one map, there are {count}: choose .npz, .func.gii or .csv")
    if channels > 1 and not holds_names(path) and suffix not in (".npy", *VOLUMES):
        raise ValueError(f"{path} holds one number a vertex, the map has {channels}: choose .mgh, .npz or .func.gii")
    as_curvature = suffix not in (".npz", ".npy", *TEXT, *VOLUMES) and not is_cifti(path) and not is_gifti(path)
    if unknown and as_curvature:
        raise ValueError(
            f"{path} cannot say NaN, which the map has where nothing is known: choose .mgh, .shape.gii or .npz"
        )
    if hemisphere is not None:
        check_named_side(path, hemisphere)
        if is_cifti(path) and not hemisphere:
            raise ValueError(f"{path} needs a hemisphere, none is known: give the surface, or hemisphere=left or right")
    check_writable(path)
