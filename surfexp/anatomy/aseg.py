"""Closed surfaces of the structures in FreeSurfer's segmentation volume aseg, by the names that BrainPrint gives them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from surfexp.anatomy.label_volume import LabelVolume
from surfexp.anatomy.subcortical import surface_of_label
from surfexp.io.declared_sizes import check_declared_sizes
from surfexp.mesh.surface import Surface

# numbers of FreeSurfer's colour table; several numbers are one structure, as in BrainPrint
STRUCTURES: dict[str, tuple[int, ...]] = {
    "CorpusCallosum": (251, 252, 253, 254, 255),
    "Cerebellum": (7, 8, 16, 46, 47),
    "Ventricles": (4, 5, 14, 24, 31, 43, 44, 63),
    "3rd-Ventricle": (14, 24),
    "4th-Ventricle": (15,),
    "Brain-Stem": (16,),
    "Left-Striatum": (11, 12, 26),
    "Left-Lateral-Ventricle": (4, 5, 31),
    "Left-Cerebellum-White-Matter": (7,),
    "Left-Cerebellum-Cortex": (8,),
    "Left-Thalamus-Proper": (10,),
    "Left-Caudate": (11,),
    "Left-Putamen": (12,),
    "Left-Pallidum": (13,),
    "Left-Hippocampus": (17,),
    "Left-Amygdala": (18,),
    "Left-Accumbens-area": (26,),
    "Left-VentralDC": (28,),
    "Right-Striatum": (50, 51, 58),
    "Right-Lateral-Ventricle": (43, 44, 63),
    "Right-Cerebellum-White-Matter": (46,),
    "Right-Cerebellum-Cortex": (47,),
    "Right-Thalamus-Proper": (49,),
    "Right-Caudate": (50,),
    "Right-Putamen": (51,),
    "Right-Pallidum": (52,),
    "Right-Hippocampus": (53,),
    "Right-Amygdala": (54,),
    "Right-Accumbens-area": (58,),
    "Right-VentralDC": (60,),
}
# standard deviations in voxels, tried in turn until the surface is a sphere in topology
BLURS = (1.3, 1.7, 2.2)


@dataclass(frozen=True)
class LabelledStructure:
    """A structure in a file of labels.

    Parameters
    ----------
    file : path
    name : str
        A key of `STRUCTURES`.
    """

    file: Path
    name: str


def read_label_volume(file: Path) -> LabelVolume:
    """Read a volume of labels: `.mgz`, `.mgh`, `.nii` or `.nii.gz`.

    Raises
    ------
    ValueError
        If the file is damaged, has no three axes, or holds numbers that are no labels.
    """
    import nibabel

    try:
        check_declared_sizes(file)
        image = nibabel.load(file)
        data = np.asarray(image.dataobj)
    except Exception as error:
        raise ValueError(f"{file} is no volume that can be read: {' '.join(str(error).split())}") from None
    if data.ndim == 4 and data.shape[3] == 1:
        data = data[..., 0]
    if data.ndim != 3:
        raise ValueError(f"{file} has {data.ndim} axes, a volume of labels has 3")
    if not np.isfinite(data).all() or (data != np.round(data)).any():
        raise ValueError(f"{file} holds fractions, a volume of labels holds whole numbers")
    return LabelVolume(data.astype(np.int64), np.asarray(image.affine, dtype=np.float64))


def structures_in(file: Path) -> dict[str, LabelledStructure]:
    """Return the structures of which a volume has voxels, by name; of a damaged one an entry that is refused when read."""
    try:
        there = set(np.unique(read_label_volume(file).labels).tolist())
    except ValueError:
        return {file.name: LabelledStructure(file, file.name)}
    return {name: LabelledStructure(file, name) for name, labels in STRUCTURES.items() if there & set(labels)}


def structure_surface(volume: LabelVolume, name: str, vertices: int = 2500) -> Surface:
    """Return the closed surface of one structure: level one half of the blurred voxels, remeshed.

    Parameters
    ----------
    volume : LabelVolume
    name : str
        A key of `STRUCTURES`.
    vertices : int

    Returns
    -------
    Surface
        In millimetres, faces outward. A note says which blur was needed for the topology of a sphere, or that none of
        them gave it; another one which share of the voxels is left out because they lie off the largest piece.

    Raises
    ------
    ValueError
        If the structure is unknown, or has too few voxels for a surface.
    """
    if name not in STRUCTURES:
        raise ValueError(f"structure {name!r} is unknown, choose one of {', '.join(STRUCTURES)}")
    one = LabelVolume(np.isin(volume.labels, STRUCTURES[name]).astype(np.int64), volume.affine)
    for blur in BLURS:
        surface = surface_of_label(one, 1, blur, vertices)
        if surface.mesh.euler_characteristic == 2:
            break
    notes: tuple[str, ...] = ()
    if surface.mesh.euler_characteristic != 2:
        notes += (f"genus {surface.mesh.genus} stays after a blur of {blur:g} voxels",)
    elif blur != BLURS[0]:
        notes += (f"handles are closed by a blur of {blur:g} voxels in place of {BLURS[0]:g}",)
    if dropped := surface.metrics["voxels_dropped"]:
        notes += (f"{100 * dropped:.2g} % of the voxels lie off the largest piece and are left out",)
    return Surface(surface.mesh, name, "mm", metrics=surface.metrics, notes=notes)
